// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/geometry/types.h"

namespace camway::scene {

/// A camera of a scene file at an instant. It looks along -Z with +Y up.
struct CameraFileKey {
  double time_s = 0.0;
  geometry::Vec3 position_m = geometry::Vec3::Zero();
  geometry::Quat orientation = geometry::Quat::Identity();  ///< not necessarily of unit length
};

/// A camera of a scene file, with the transforms of the nodes that it hangs from.
struct SceneFileCamera {
  std::string name;
  std::optional<double> fov_x_rad;  ///< full angle across
  std::optional<double> aspect;     ///< width of the picture divided by its height
  std::optional<double> near_m;
  int takes = 0;  ///< animations of the file that move it, of which the first counts
  std::vector<CameraFileKey>
      keys;  ///< at the times of its animation's keys; one if it stands still
};

/// Reads the cameras of a file that assimp reads (FBX, COLLADA, ...), in the confined import
/// process. The unit of the file is applied; axes are as in `import_mesh`. Fails with a sentence
/// that names the file. Thread-safe.
base::Result<std::vector<SceneFileCamera>> import_cameras(const std::filesystem::path& file);

/// Parses what the import process says of cameras. Nothing of it is trusted. Fails with the line.
base::Result<std::vector<SceneFileCamera>> cameras_from(const std::string& text, double unit_m);

}  // namespace camway::scene
