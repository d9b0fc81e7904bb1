// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/record/import_format.h"

namespace camway::scene {

/// Whether files whose names end so (".bt", ".ot", in any case) are OctoMap's.
bool is_map_extension(std::string_view extension);

/// Reads a map with OctoMap's own readers into `record.map`: occupied and free leaves, as its own
/// thresholds have it. They trust the file, and may crash or take any memory: for the import
/// process only. Returns why the file is refused, or an empty text.
std::string read_map(const std::string& file, std::string_view extension,
                     import_format::Record& record);

}  // namespace camway::scene
