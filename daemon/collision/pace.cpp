// SPDX-License-Identifier: MIT
#include "daemon/collision/pace.h"

#include <algorithm>
#include <cmath>

namespace camway::collision {

namespace {

// Chosen by measurement over furnished and empty scenes.
constexpr double kTrust = 0.7;   // in a gap that was foretold
constexpr double kGrowth = 2.0;  // where nothing was in sight
constexpr double kLargestGrowth = 6.0;
constexpr double kLargestShare = 0.6;      // of a reach that was too long
constexpr double kUnknownApproach = -0.5;  // change of the gap with motion where nothing is known

}  // namespace

double Pace::next_reach_m(const Look& seen) {
  const double at_m = here_m_ + seen.reach_m;
  if (seen.free) here_m_ += 2.0 * seen.reach_m;
  if (!seen.is_measured) {
    before_.reset();
    return std::max(kGrowth * seen.reach_m, kTrust * seen.gap_m);
  }
  const double gap_m = std::max(seen.gap_m, 0.0);
  // The gap changes by no more than the body moves.
  double slope = seen.free ? 0.0 : kUnknownApproach;
  if (before_ && before_->at_m != at_m) {
    slope = std::clamp((gap_m - before_->gap_m) / (at_m - before_->at_m), -1.0, 1.0);
  }
  before_ = Sight{at_m, gap_m};
  // The next look is from here + r, where the gap will be about gap + slope·(here + r - at); that
  // should be r or more.
  const double at_edge_m = gap_m + slope * (here_m_ - at_m);
  const double reach_m = kTrust * at_edge_m / (1.0 - kTrust * slope);
  const double most_m = (seen.free ? kLargestGrowth : kLargestShare) * seen.reach_m;
  return std::clamp(reach_m, 0.0, most_m);
}

void Pace::pass(double reach_m) {
  here_m_ += 2.0 * reach_m;
  before_.reset();
}

}  // namespace camway::collision
