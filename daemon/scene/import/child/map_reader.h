// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {

/// Whether this is an extension of OctoMap files (".bt", ".ot", in any case).
bool is_map_extension(std::string_view extension);

/// Reads a map with OctoMap's readers into `record.map`: its occupied and its free leaves, by its
/// own thresholds. These readers trust the file, and may crash or use any amount of memory: for the
/// import process only. Returns why the file is refused, or an empty text.
std::string read_map(const std::string& file, std::string_view extension,
                     import_record::Record& record);

}  // namespace camway::scene
