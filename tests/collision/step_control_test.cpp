// SPDX-License-Identifier: MIT
#include "daemon/collision/step_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace camway::collision {
namespace {

/// Returns the probe of a plane `gap_m` ahead of the beginning of a stretch, when every point moves
/// towards it by `slope` times its motion.
ProbeResult look_at_plane(double gap_m, double slope, double reach_m) {
  const double closing_m = 2.0 * slope * reach_m;
  ProbeResult seen;
  seen.reach_m = reach_m;
  seen.free = gap_m > closing_m;
  seen.gap_m = gap_m - 0.5 * closing_m;
  seen.step_scale = (seen.free ? gap_m - closing_m : gap_m) / closing_m;
  return seen;
}

/// Moves towards the plane until it is resolved to `finest_m`. Returns the number of probes.
int looks_until(double gap_m, double slope, double finest_m) {
  double reach_m = 1.0;
  for (int looks = 1; looks < 10'000; ++looks) {
    const ProbeResult seen = look_at_plane(gap_m, slope, reach_m);
    if (seen.free) {
      gap_m -= 2.0 * slope * reach_m;
    } else if (reach_m <= finest_m) {
      return looks;
    }
    const double next_m = next_reach_m(seen);
    EXPECT_TRUE(seen.free || next_m < reach_m);
    reach_m = std::max(next_m, 0.9 * finest_m);
  }
  return 10'000;
}

TEST(StepControl, ClosesInOnAPlaneByOrdersOfMagnitude) {
  // Halving would take at least 2·log2(10 / 1e-6) = 46 probes for any slope.
  for (const double slope : {1.0, 0.3, 0.01}) {
    EXPECT_LE(looks_until(10.0 * slope, slope, 1e-6), 14) << slope;
  }
}

TEST(StepControl, IsNotTemptedFarBeyondWhatWasSeen) {
  ProbeResult seen = look_at_plane(1e6, 1e-3, 0.1);
  ASSERT_TRUE(seen.free);
  EXPECT_GT(next_reach_m(seen), 0.1);
  EXPECT_LE(next_reach_m(seen), 1.0);
}

TEST(StepControl, GrowsByTheLowerBoundOfAGapThatWasNotMeasured) {
  ProbeResult seen;
  seen.free = true;
  seen.is_measured = false;
  seen.reach_m = 0.1;
  seen.gap_m = 5.0;
  EXPECT_GT(next_reach_m(seen), 1.0);
  EXPECT_LT(next_reach_m(seen), 5.0);
}

TEST(StepControl, FitsTheWidthToTheReach) {
  EXPECT_EQ(width_factor(2.0, 1.0, kDetectionGrowth), 0.5);
  EXPECT_EQ(width_factor(1.0, 100.0, kDetectionGrowth), kDetectionGrowth);
  // A step that is mostly rounding must not shrink to nothing.
  EXPECT_GT(width_factor(1.0, 0.0, kDetectionGrowth), 0.0);
}

TEST(StepControl, ChecksAStepOfUnknownReach) {
  EXPECT_TRUE(is_too_long(2.0, 1.0));
  EXPECT_FALSE(is_too_long(1.2, 1.0));
  EXPECT_FALSE(is_too_long(std::numeric_limits<double>::infinity(), 1.0));
  EXPECT_FALSE(is_too_long(std::numeric_limits<double>::quiet_NaN(), 1.0));
}

}  // namespace
}  // namespace camway::collision
