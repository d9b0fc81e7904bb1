// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/correction/free_space.h"
#include "daemon/motion/bump.h"

namespace camway::correction {

/// A way that is free of collision but not smooth: straight motions from pose to pose. What
/// searches find, and what a correction is then drawn towards.
using Guide = std::vector<motion::SignedPose>;

/// The way that `path` itself takes at a time, with the sign that its image has there.
motion::SignedPose signed_pose_at(const motion::CubicPath& path, double time_s);

/// Coefficients of a row of bumps that replaces a path between two keyframes, which stand at the
/// first and the last of the row's own knots.
struct Offsets {
  motion::KnotRow knots;
  int first = 1;  ///< knot of the first coefficient; below 1 it is before the first keyframe
  std::vector<motion::CubicPoint> at;

  [[nodiscard]] int last() const { return first + static_cast<int>(at.size()) - 1; }
  /// The coefficient at knot `k`; zero outside the row.
  [[nodiscard]] motion::CubicPoint operator()(int k) const {
    return k < first || k > last() ? motion::CubicPoint{} : at[static_cast<std::size_t>(k - first)];
  }
};

/// The offsets of `guide`, which begins and ends where the path is at the ends of `knots`, and is
/// passed so that it stays close to the path at the same time without hurrying. Nothing where the
/// guide's orientation cannot be lifted to the path's image: it would arrive with the other sign.
std::optional<Offsets> offsets_to(const motion::CubicPath& path, const Guide& guide,
                                  const motion::KnotRow& knots, const FreeSpace& space);

/// What a row of bumps does at the two keyframes.
enum class Ends {
  kFree,   ///< keeps them, but may change the path's slope there, and so what is beyond
  kFixed,  ///< changes nothing there, nor beyond
};

/// The offsets as a row of bumps: Schoenberg's operator, which swings no more than they do
/// (Schoenberg 1967, "On spline functions", variation diminishing). What is to be zero at the
/// keyframes is made so.
motion::BumpRow bumps_for(const Offsets& offsets, Ends ends);

/// The coefficient of the bump at a keyframe that makes the sum zero there.
motion::CubicPoint holding(const motion::CubicPoint& before, const motion::CubicPoint& after);

/// Leaves out poses of `guide` where the straight motion between others is free and shorter.
Guide shortened(const Guide& guide, FreeSpace& space, double margin_m);

}  // namespace camway::correction
