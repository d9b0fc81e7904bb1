// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/path/guide.h"

namespace camway::correction {

struct TreeOptions {
  int max_samples = 3000;
  double margin_m = 0.0;  ///< distance that the guide keeps beyond the required clearance
  /// The polyline, from end to end, about which samples are drawn: a way for a smaller ball.
  /// [Limit: two points or more]
  std::vector<geometry::Vec3> about_W;
  double reach_m = 0.0;           ///< largest distance of samples from it
  double largest_turn_rad = 1.9;  ///< largest angle of samples from orientations between the ends'
  /// Poses of the interpolated path at equal steps in time, for the orientation policy [Limit: two
  /// or more]. The way has no times yet, so a sample is compared with the pose at its share of the
  /// way `about_W`; the path must meet the policy later.
  std::vector<motion::Pose> interpolated;
  std::uint64_t seed = 1;
};

struct TreeResult {
  /// The poses from begin to end, both included; empty if none was found.
  Guide guide;
  std::int32_t samples = 0;  ///< number of random samples drawn
};

/// Finds a way for the body, turning included: two trees of straight motions grow from both ends
/// towards random poses and each other (Kuffner & LaValle 2000, "RRT-Connect"). Every motion is
/// proved free, not sampled. Deviations:
/// - a blocked motion is followed up to the obstacle, however long it is;
/// - some samples are drawn near places where motions were blocked recently, which finds narrow
///   passages;
/// - orientations carry a sign, so that the way arrives with the sign of `to`.
///
/// Deterministic for a seed, unless the deadline strikes.
TreeResult tree_way(FreeSpace& space, const motion::SignedPose& from, const motion::SignedPose& to,
                    const TreeOptions& options, const base::Deadline& deadline);

}  // namespace camway::correction
