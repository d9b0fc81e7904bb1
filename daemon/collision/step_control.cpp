// SPDX-License-Identifier: MIT
#include "daemon/collision/step_control.h"

#include <algorithm>

namespace camway::collision {

namespace {

// Chosen by measurement over furnished and empty scenes.
constexpr double kTrust = 0.97;        // share of the predicted room that is used
constexpr double kFieldTrust = 0.7;    // share of the distance field, which knows no direction
constexpr double kReachGrowth = 4.0;   // largest; motion is not predictable beyond
constexpr double kLargestShare = 0.8;  // share of a reach that was too long

// One reading of the clock costs as much as one look-up in the distance field.
constexpr unsigned kStepsPerClock = 16;
// A step of a body that has a tree may take a thousand times as long.
constexpr unsigned kStepsPerClockOfTree = 1;

}  // namespace

unsigned steps_per_clock(const Probe& probe) {
  return probe.body().tree() != nullptr ? kStepsPerClockOfTree : kStepsPerClock;
}

double next_reach_m(const ProbeResult& seen) {
  if (!seen.free) return std::min(kTrust * seen.step_scale, kLargestShare) * seen.reach_m;
  if (seen.is_measured) return std::min(kTrust * seen.step_scale, kReachGrowth) * seen.reach_m;
  return std::max(kReachGrowth * seen.reach_m, kFieldTrust * seen.gap_m);
}

}  // namespace camway::collision
