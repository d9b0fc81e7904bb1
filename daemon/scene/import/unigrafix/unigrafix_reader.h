// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/import/unigrafix/unigrafix_parser.h"

namespace camway::scene::unigrafix {

/// More do not fit into the memory of the import process, by default.
inline constexpr std::uint64_t kMostVerticesAndFaces = 100'000'000;

/// Whether files with this extension (".ug", in any case) are read as UniGrafix.
bool is_unigrafix_extension(std::string_view extension);

/// Reads a UniGrafix scene, with coordinates in doubles: faces with holes, definitions, instances
/// and arrays, and files that it includes. Reads over colours, lights and cameras, and counts wires
/// as lines. Each instance is an object of its name.
///
/// Accepts any bytes. A file of a few bytes can ask for any number of instances; one whose vertices
/// and faces come to more than `most` is refused. Returns a record as in `record_layout.h`
/// without the header's counts, or the reason why the file cannot be read.
base::Result<import_record::Record> read_unigrafix(std::string_view text,
                                                   const OpenInclude& open_include,
                                                   std::uint64_t most = kMostVerticesAndFaces);

}  // namespace camway::scene::unigrafix
