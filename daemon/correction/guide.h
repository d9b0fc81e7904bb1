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

/// What has to be added to a path at the inner knots of a row, so that it passes there where a
/// guide does.
struct Offsets {
  motion::KnotRow knots;
  std::vector<motion::CubicPoint> at;  ///< knots 1 .. count - 1
};

/// The offsets of `guide`, which begins and ends where the path is at the ends of `knots` and is
/// passed at constant speed, as `FreeSpace::distance_m` measures it. Nothing where the guide's
/// orientation cannot be lifted to the path's image: it would arrive with the other sign.
std::optional<Offsets> offsets_to(const motion::CubicPath& path, const Guide& guide,
                                  const motion::KnotRow& knots, const FreeSpace& space);

/// The same, each made as small as it can be so that its pose still is free and was all the way
/// from the guide's; neighbours differ in how much is left of them by `slope` at the most. [Limit:
/// 0 < slope <= 1]
Offsets pulled_back(const motion::CubicPath& path, const Offsets& offsets, double slope,
                    double margin_m, FreeSpace& space);

/// What a row of bumps does at the keyframes at its ends.
enum class Ends {
  kFree,   ///< keeps them, but may change the path's slope there, and so a little beyond
  kFixed,  ///< changes nothing there, nor beyond
};

/// Bumps with the offsets as coefficients: Schoenberg's operator, which swings no more than they do
/// (Schoenberg 1967, "On spline functions", variation diminishing).
motion::BumpRow bumps_for(const Offsets& offsets, Ends ends);

/// Leaves out poses of `guide` where the straight motion between others is free and shorter.
Guide shortened(const Guide& guide, FreeSpace& space, double margin_m);

}  // namespace camway::correction
