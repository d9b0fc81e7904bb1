// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// What an objective says of a stretch of path, as its measures in an answer will: as computed from
/// samples where there is no closed form, and no part of any proof.
struct ObjectiveCost {
  /// Less is better. `kClosest`: largest distance of the eye from the original at the same time
  /// [Units: metres]; `kShortest`: length of its way [Units: metres]; `kSmoothest`: bending energy
  /// [Units: m²/s³]; `kSafest`: how much is missing to a gap that is as good as any, squared, as a
  /// share of that gap, integrated over the way of the eye [Units: metres].
  double value = 0.0;
  /// The least gap, or one that is wide enough for the objective: of samples, but for `kSafest`
  /// `collision::path_clearance`. 0 for `kClosest`, which is asked often, and keeps what gaps
  /// relaxation leaves. [Units: metres]
  double least_gap_m = 0.0;
};

/// Gaps wider than this, in radii of the ball that holds the body, are as good as any to `kSafest`.
inline constexpr double kComfort = 3.0;

/// `original` covers the time of `path`. If the deadline strikes, the value is infinite.
ObjectiveCost objective_cost(Objective objective, const motion::CubicPath& path,
                             const motion::CubicPath& original, FreeSpace& space,
                             const collision::Deadline& deadline);

/// Integral of the squared acceleration of the eye. [Units: m²/s³]
double bending_energy(const motion::CubicPath& path);

/// Whether `now` is better by more than what it takes to be worth a change, and nowhere nearer than
/// the nearest before, where that was near, rounding and sampling apart.
bool is_better(const ObjectiveCost& now, const ObjectiveCost& before);

}  // namespace camway::correction
