// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "daemon/base/result.h"
#include "daemon/scene/import/readers/included_file.h"

namespace camway::scene {

/// Returns the canonical path of `name`, which is relative to `folder` or absolute, links followed.
/// Fails with the reason if it is not in the folder or below it, or is no regular file. Requires a
/// canonical folder.
base::Result<std::filesystem::path> path_below(const std::filesystem::path& folder,
                                               const std::filesystem::path& name);

/// Opens the files that `scene` includes: relative to the file that includes them, and only in the
/// folder of `scene` or below it, links followed.
OpenInclude files_below(const std::filesystem::path& scene);

}  // namespace camway::scene
