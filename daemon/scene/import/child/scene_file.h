// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::scene {

/// Reads a scene file by the reader of its extension, and writes a record of it or of a refusal:
/// readers of our own, OctoMap for occupancy maps, assimp for all else. Returns the exit code. For
/// the import process alone.
int import_scene_file(const std::string& file);

}  // namespace camway::scene
