// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "tests/support/random.h"
#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// Returns keys with random poses, `step_s` apart, each turned by up to `largest_turn_rad` from the
/// one before.
inline CameraTrack random_track(testing::Random& random, std::size_t keys, double step_s,
                                double largest_turn_rad) {
  CameraTrack track;
  geometry::Quat orientation = random.rotation();
  for (std::size_t i = 0; i < keys; ++i) {
    const geometry::Vec3 position = random.in_cube(20.0);
    track.keys.push_back({static_cast<double>(i) * step_s, {position, orientation}, std::nullopt});
    orientation = geometry::Quat(
        Eigen::AngleAxisd(random.uniform(0.0, largest_turn_rad), random.direction()) * orientation);
    // Either quaternion of an orientation may stand in a file.
    if (random.chance(0.3)) orientation.coeffs() *= -1.0;
  }
  return track;
}

}  // namespace camway::tools
