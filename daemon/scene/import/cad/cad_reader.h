// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::cad {

/// More do not fit into the memory of the import process, by default.
inline constexpr std::size_t kMostTriangles = 50'000'000;

/// Reads a STEP file, or an IGES file if `is_iges`, and makes triangles of its faces
/// (`part_mesher.h`). Each solid is an object, as are the faces that belong to none together. A
/// part that is used several times is made flat once. Coordinates are in the file's unit, which the
/// header has.
///
/// The library trusts its file, and may crash or use any amount of memory: for an import process
/// only. Returns a record as in `record_layout.h` without the header's counts, or the reason why
/// the file is refused. Throws `std::exception`s for what the library throws. Requires `start_cad`.
base::Result<import_record::Record> read_cad(const std::string& file, bool is_iges);

}  // namespace camway::scene::cad
