// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/correction/free_space.h"
#include "daemon/motion/bump.h"

namespace camway::correction {

/// A way that is free of collision but not smooth: straight motions from pose to pose. What searches
/// find, and what a correction is then drawn towards.
using Guide = std::vector<motion::SignedPose>;

/// The way that `path` itself takes at a time, with the sign that its image has there.
motion::SignedPose signed_pose_at(const motion::CubicPath& path, double time_s);

/// The stretch of a path that a guide takes the place of, cut into knots.
struct Window {
  double begin_s = 0.0;
  double end_s = 0.0;
  /// Whether there is a keyframe at that end. It is kept, but the path may change its slope there, so
  /// that also what is before or after it changes a little.
  bool is_keyframe_at_begin = false;
  bool is_keyframe_at_end = false;
};

/// Bumps that draw `path` towards `guide`, which begins and ends where the path is at the ends of
/// the window: Schoenberg's operator on the difference of the two, at `count` equidistant knots
/// (Schoenberg 1967; variation diminishing, so that the correction swings no more than the guide).
/// The more knots, the closer. The guide is passed at constant speed, as `FreeSpace::distance_m`
/// measures it. Nothing where the guide's orientation cannot be lifted to the path's image: it would
/// arrive with the other sign. [Limit: count >= 4]
std::optional<motion::BumpRow> drawn_towards(const motion::CubicPath& path, const Guide& guide,
                                             const Window& window, int count,
                                             const FreeSpace& space);

/// Leaves out poses of `guide` where the straight motion between others is free and shorter.
Guide shortened(const Guide& guide, FreeSpace& space, double margin_m);

}  // namespace camway::correction
