// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "daemon/collision/probe.h"

namespace camway::collision {

// How detection and the search of the clearance choose steps along a path. The *width* of a step is
// its range of the segment's parameter. Its *reach* is the bound of the body's motion from the
// middle (`ProbeResult::reach_m`). `next_reach_m` chooses the reach to aim at. A step whose reach
// is much longer is not checked but shortened. The next width follows from the ratio of the two
// reaches. No constant here changes what is proved.

/// Largest growth of a width from one step to the next, in detection and in the search of the
/// clearance. Twice either value changes the number of checks by less than a hundredth, over
/// furnished and empty scenes. The two differ for no other reason than that they were chosen
/// separately, and stay as they are because bits of answers depend on the steps.
constexpr double kDetectionGrowth = 8.0;
constexpr double kClearanceGrowth = 4.0;

/// Returns the number of steps between two readings of the clock.
unsigned steps_per_clock(const Probe& probe);

/// Returns the reach to aim at for the next stretch. If `seen` is free, the next stretch begins
/// where `seen` ends; otherwise it begins where `seen` begins. The reach is the largest one that
/// the obstacles near `seen` are estimated to allow if the body keeps its motion: it follows from
/// `ProbeResult::step_scale`. The result affects the number of checks, not what is proved.
/// [Units: metres]
double next_reach_m(const ProbeResult& seen);

/// Returns whether a step of `reach_m` is so much longer than `target_reach_m` that a check would
/// most likely fail to prove it free. False if the reach is not finite. Detection passes the reach
/// without rounding (`ProbeResult::motion_m`), here and to `width_factor`, because a shorter step
/// has no less rounding. [Limit: 0 < target_reach_m]
inline bool is_too_long(double reach_m, double target_reach_m) {
  constexpr double kLongestWorthChecking = 1.5;  // in target reaches, by measurement
  return std::isfinite(reach_m) && reach_m > kLongestWorthChecking * target_reach_m;
}

/// Returns the factor by which to multiply the width of a step of `reach_m`, so that the next step
/// has about `target_reach_m`. Assumes that reach is proportional to width. The result is in
/// [1/64, `largest`]. The lower bound is there because the reach of a tiny step is mostly rounding.
/// [Limit: 0 < target_reach_m] [Limit: 1/64 <= largest]
inline double width_factor(double reach_m, double target_reach_m, double largest) {
  constexpr double kSmallestFactor = 1.0 / 64.0;
  return std::clamp(target_reach_m / reach_m, kSmallestFactor, largest);
}

}  // namespace camway::collision
