// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "daemon/collision/probe.h"

namespace camway::collision {

// How detection and the search of the clearance walk a path. A step is checked if its reach is
// about the reach aimed at; the width of the next one follows from the ratio of the two. None of
// the constants changes what is proved.

/// Largest growth of a width from one step to the next, in detection and in the search of the
/// clearance. Twice either value changes the number of checks by less than a hundredth, over
/// furnished and empty scenes. The two differ for no other reason than that they were chosen
/// separately, and stay as they are because bits of answers depend on the steps.
constexpr double kDetectionGrowth = 8.0;
constexpr double kClearanceGrowth = 4.0;
/// Number of steps between two readings of the clock, which take as long as a look-up in the
/// distance field.
constexpr unsigned kStepsPerClock = 16;

/// Returns the reach to aim at for the next stretch. If `seen` is free, the next stretch begins
/// where `seen` ends; otherwise it begins where `seen` begins. The reach is the largest one that
/// the obstacles near `seen` are estimated to allow if the body keeps its motion. The result
/// affects the number of checks, not what is proved. [Units: metres]
double next_reach_m(const ProbeResult& seen);

/// Returns whether a step of that reach is so much longer than aimed at that a check would most
/// likely be wasted. False if the reach is not finite.
inline bool is_too_long(double reach_m, double target_reach_m) {
  constexpr double kWorthACheck = 1.5;  // share of the reach aimed at, by measurement
  return std::isfinite(reach_m) && reach_m > kWorthACheck * target_reach_m;
}

/// Returns the factor by which the width of a step of that reach becomes that of a step of the
/// reach aimed at, as if the reach was proportional to the width; at most `largest`. The reach of a
/// tiny step is mostly rounding, so the factor has a lower bound, too.
inline double width_factor(double reach_m, double target_reach_m, double largest) {
  constexpr double kLargestShrink = 1.0 / 64.0;
  return std::clamp(target_reach_m / reach_m, kLargestShrink, largest);
}

}  // namespace camway::collision
