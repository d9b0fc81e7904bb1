// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "daemon/scene/import.h"
#include "daemon/scene/snapshot.h"

namespace camway::scene {

/// As those without `stop`. A stop that is asked for ends the reading of the file, and the making of
/// an occupancy mirror, within milliseconds, and it fails.
ImportResult import_mesh(const std::filesystem::path& file, const ImportOptions& options,
                         const std::stop_token& stop);
SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options, const std::stop_token& stop);

}  // namespace camway::scene
