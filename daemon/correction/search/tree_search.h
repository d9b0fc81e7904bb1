// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/path/correction.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

struct TreeOptions {
  int max_samples = 3000;
  double margin_m = 0.0;  ///< that the guide keeps beside what is required
  /// About which samples are drawn, from end to end: a way for something smaller than the body.
  std::vector<geometry::Vec3> about_W;
  double reach_m = 0.0;           ///< how far from it
  double largest_turn_rad = 1.9;  ///< of samples, from orientations between the two ends
  /// Of the gap, at equal steps in time [Limit: 2 or more]. The way has no time yet: the rule for
  /// orientations is applied at the share of the way `about_W`. The path has to meet it afterwards.
  std::vector<motion::Pose> interpolated;
  std::uint64_t seed = 1;
  Effort* effort = nullptr;  ///< where samples are counted; may be null
};

/// A way for the body itself, turning included: two trees of straight motions grow from both ends
/// towards random poses and each other (Kuffner & LaValle 2000, "RRT-Connect"). Every motion is
/// proved free, not sampled. Deviations: a motion that is blocked is followed up to the obstacle,
/// however long it is; some samples are drawn next to where motions were blocked last, which finds
/// narrow gaps; and orientations carry a sign, so that the way arrives as `to` is signed.
///
/// Deterministic for a seed. Empty if none was found; first and last pose are `from` and `to`.
Guide tree_way(FreeSpace& space, const motion::SignedPose& from, const motion::SignedPose& to,
               const TreeOptions& options, const collision::Deadline& deadline);

}  // namespace camway::correction
