// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::collision {

/// The filled near quadrilateral as two triangles that share a diagonal.
std::array<geometry::Triangle, 2> near_quad_triangles(const motion::Corners& corners);

/// Whether the filled near quadrilateral at `pose` touches the scene. An object that passes through
/// its interior counts, not only one that crosses its outline.
bool collides(const scene::SceneIndex& index, const motion::Corners& corners_C,
              const motion::Pose& pose);

/// Returns the distance from the filled near quadrilateral at `pose` to the scene, 0 if they touch;
/// nothing if the distance is `cutoff_m` or more.
std::optional<double> clearance_m(const scene::SceneIndex& index, const motion::Corners& corners_C,
                                  const motion::Pose& pose, double cutoff_m);

}  // namespace camway::collision
