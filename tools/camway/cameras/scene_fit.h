// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"

namespace camway::tools {

/// A camera file and its path, as placed in a scene.
struct PlacedPath {
  std::string file;
  bool has_unit = false;  ///< whether its format says what a unit is, so that it was applied
  double scale = 1.0;     ///< metres per unit, or a factor beside the unit of the format
  std::vector<geometry::Vec3> keyframes_W;
};

/// Reads a scene file, and returns sentences on what speaks against it as the scene of a path: that
/// it cannot be read, that one scale means other things for both files, that the path is nowhere in
/// it. Empty if nothing does.
std::vector<std::string> scene_warnings(const std::string& scene,
                                        const scene::ImportOptions& options,
                                        const PlacedPath& path);

}  // namespace camway::tools
