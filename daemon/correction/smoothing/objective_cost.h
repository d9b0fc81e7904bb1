// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// Value of an objective for a part of a path, by the measures that answers report. Computed from
/// samples where there is no closed form; no part of any proof.
struct ObjectiveCost {
  /// Less is better.
  /// - `kClosest`: `closeness_cost` [Units: radian seconds]
  /// - `kShortest`: length of the eye's curve [Units: metres]
  /// - `kSmoothest`: bending energy [Units: m²/s³]
  /// - `kSafest`: (1 - gap/c)², with gaps above the sufficient gap c counted as c, integrated over
  ///   the length of the eye's curve [Units: metres]
  double value = 0.0;
  /// For `kSafest` the least gap over the path by `collision::path_clearance`, or a sufficient gap
  /// if that is less. 0 for others, which keep gaps by proofs. [Units: metres]
  double least_gap_m = 0.0;
};

/// The sufficient gap of `kSafest`, in radii of the ball that holds the body: larger gaps are no
/// better.
inline constexpr double kComfort = 3.0;

/// The gap below which `kShortest` and `kSmoothest` come no nearer to the scene than the closest
/// path does, in radii of the ball that holds the body.
inline constexpr double kTightGap = 0.02;

/// Evaluates `objective` on `path`. Requires `original` to cover the time of `path`. For `kSafest`
/// the value is infinite if the deadline strikes; other objectives ignore the deadline.
ObjectiveCost objective_cost(Objective objective, const motion::CubicPath& path,
                             const motion::CubicPath& original, FreeSpace& space,
                             const base::Deadline& deadline);

/// The same without the least gap, which takes `kSafest` most of its time.
double objective_value(Objective objective, const motion::CubicPath& path,
                       const motion::CubicPath& original, FreeSpace& space);

/// Integral of the squared acceleration of the eye over time. [Units: m²/s³]
double bending_energy(const motion::CubicPath& path);

/// Whether `now` is better by enough to be worth a change and its least gap is no smaller.
bool is_better(const ObjectiveCost& now, const ObjectiveCost& before);

}  // namespace camway::correction
