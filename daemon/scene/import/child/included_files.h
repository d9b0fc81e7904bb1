// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "daemon/scene/import/unigrafix/unigrafix_parser.h"

namespace camway::scene {

/// Opens the files that `scene` includes: relative to the file that includes them, and only in the
/// folder of `scene` or below it, links followed.
unigrafix::OpenInclude files_below(const std::filesystem::path& scene);

}  // namespace camway::scene
