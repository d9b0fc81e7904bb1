// SPDX-License-Identifier: MIT
#include "daemon/collision/least_gap.h"

#include <limits>

namespace camway::collision {
namespace {

// Upper bound of the rounding of a bound: sums and a product.
constexpr double kRoundDown = 1.0 - 4.0 * std::numeric_limits<double>::epsilon();

}  // namespace

double least_gap_at_middle_m(const Probe& probe, const ProbeResult& measured, double share) {
  const double required_m = probe.required_distance_m();
  return kRoundDown * (share * (measured.gap_m + required_m) - required_m);
}

double least_gap_m(double at_middle_m, const ProbeResult& seen) {
  return at_middle_m - (seen.reach_m + seen.rounding_m) / kRoundDown;
}

}  // namespace camway::collision
