// SPDX-License-Identifier: MIT
#include "daemon/collision/pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace camway::collision {
namespace {

// Walks along a motion whose gap is known everywhere until it is resolved to `finest_m`; returns
// how many looks that took.
int looks_until(const std::function<double(double)>& gap_at, double end_m, double finest_m) {
  Pace pace;
  double here_m = 0.0;
  double reach_m = 1.0;
  int looks = 0;
  while (here_m < end_m && looks < 10'000) {
    ++looks;
    Look seen;
    seen.reach_m = reach_m;
    seen.gap_m = gap_at(here_m + reach_m);
    seen.free = seen.gap_m > reach_m;
    const double next_m = pace.next_reach_m(seen);
    if (seen.free) {
      here_m += 2.0 * reach_m;
    } else {
      EXPECT_LT(next_m, reach_m);
      if (reach_m <= finest_m) break;
    }
    reach_m = std::max(next_m, 0.9 * finest_m);
  }
  return looks;
}

TEST(Pace, ClosesInOnAnObstacleAheadByOrdersOfMagnitude) {
  // 10 m away, head-on; halving would take 2·log2(10 / 1e-6) looks and more.
  const int looks = looks_until([](double at_m) { return 10.0 - at_m; }, 10.0, 1e-6);
  EXPECT_LE(looks, 24);
}

TEST(Pace, KeepsStepBesideAWall) {
  // A gap of 0.1 m all along 20 m: 100 stretches of a reach of 0.1 m are the least.
  const int looks = looks_until([](double) { return 0.1; }, 20.0, 1e-6);
  EXPECT_GE(looks, 100);
  EXPECT_LE(looks, 200);
}

TEST(Pace, LeavesAnObstacleAsFastAsItCame) {
  const int looks =
      looks_until([](double at_m) { return 1e-4 + 0.8 * std::max(at_m, 0.0); }, 10.0, 1e-7);
  EXPECT_LE(looks, 40);
}

TEST(Pace, GrowsByTheLowerBoundOfAGapThatWasNotMeasured) {
  Pace pace;
  Look seen;
  seen.free = true;
  seen.is_measured = false;
  seen.reach_m = 0.1;
  seen.gap_m = 5.0;
  EXPECT_GT(pace.next_reach_m(seen), 1.0);
  EXPECT_LT(pace.next_reach_m(seen), 5.0);
}

}  // namespace
}  // namespace camway::collision
