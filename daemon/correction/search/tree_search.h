// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// Turn of samples from the orientations between the ends, at most. Chosen by measurement.
inline constexpr double kLargestTreeTurn_rad = 1.9;

/// Options of `tree_way`.
struct TreeOptions {
  int max_samples = 3000;  ///< limit of the random samples [Limit: value >= 0]
  double margin_m = 0.0;   ///< distance that the guide keeps beyond the required clearance
  /// The polyline from `from` to `to` about which samples are drawn, such as a way of a smaller
  /// ball. [Limit: two points or more]
  std::vector<geometry::Vec3> about_W;
  double reach_m = 0.0;  ///< largest distance of samples from `about_W`
  /// Largest angle between samples and the orientations from `from` to `to`.
  double largest_turn_rad = kLargestTreeTurn_rad;
  /// Poses of the interpolated path at equal steps in time, for the orientation policy. The way has
  /// no times yet, so a sample is compared with the pose at its share of the length of `about_W`.
  /// The caller must check later that the path meets the policy. [Limit: two or more]
  std::vector<motion::Pose> interpolated;
  std::uint64_t seed = 1;  ///< random seed
};

struct TreeResult {
  /// The poses of the way, from `from` to `to`, both included; empty if no way was found.
  Guide guide;
  std::int32_t samples = 0;  ///< number of random samples drawn
};

/// Searches a way for the body on which it may turn. Two trees of straight motions grow from the
/// two ends towards random poses and each other (Kuffner & LaValle 2000, "RRT-Connect"). Every
/// motion is proved free, not sampled. Deviations:
/// - a blocked motion is followed up to the obstacle, however long it is;
/// - some samples are drawn near places where motions were blocked recently, which finds narrow
///   passages;
/// - orientations carry a sign, so that the way arrives with the sign of `to`.
///
/// Deterministic for a seed, unless the deadline strikes.
TreeResult tree_way(FreeSpace& space, const motion::SignedPose& from, const motion::SignedPose& to,
                    const TreeOptions& options, const base::Deadline& deadline);

}  // namespace camway::correction
