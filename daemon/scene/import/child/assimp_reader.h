// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::scene {

/// Reads the meshes of a file of any format that assimp knows, and writes a record of them or of a
/// refusal. Returns the exit code. `extension` has the dot, and decides for COLLADA. For the import
/// process alone: assimp may crash.
int import_with_assimp(const std::string& file, const std::string& extension);

/// Reads the cameras of a file as `import_with_assimp` reads its meshes.
int import_cameras_with_assimp(const std::string& file);

}  // namespace camway::scene
