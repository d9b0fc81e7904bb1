// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "daemon/correction/path/constraints.h"
#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// The quantity that the slow search lowers. Not thread-safe.
struct Goal {
  /// Cost of a part of a path, made of whole pieces. Less is better. The cost of a path is the sum
  /// of those of its parts, so a step is judged by the part that it changes.
  std::function<double(const motion::CubicPath&)> cost;
  bool may_turn = true;  ///< whether the search may change orientations
  /// Size of the first steps, if the start's offset from the path as interpolated is smaller.
  /// [Units: metres]
  double least_height_m = 0.0;
};

/// Returns the goal of the default objective, `Shot::cost`. Refers to `shot`.
Goal closeness_goal(const Shot& shot);

/// Returns the goals that stand for an objective, to be sought one after the other. They do not
/// turn the camera, as the objectives other than `kClosest` do not. Refer to `shot`.
/// - `kShortest`: length of the eye's curve [Units: metres]
/// - `kSmoothest`: bending energy [Units: m²/s³]
/// - `kSafest`: `danger_goal` with each of `kSharpness`
std::vector<Goal> goals_of(correction::Objective objective, const Shot& shot);

/// Stands for the least gap, which is no sum over parts: the integral over the eye's curve of
/// ((c + e) / (g + e))^p - 1, where g is the distance from the scene, at most c, c the sufficient
/// gap (`sufficient_gap_m`), p the sharpness and e = `kSoftShare` * c. The larger p is, the more
/// the least gap alone counts. [Units: metres]
Goal danger_goal(const Shot& shot, double sharpness);

/// The first finds the way, the second the middle of it.
inline constexpr double kSharpness[] = {4.0, 16.0};
inline constexpr double kSoftShare = 0.02;

/// The gap above which `kSafest` gains nothing: `correction::kComfort` radii of the ball that holds
/// the body. [Units: metres]
double sufficient_gap_m(const Shot& shot);

}  // namespace camway::bench
