// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/box_costs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr std::uint64_t kCostsSeed = 20261122;

struct Costs {
  double total;
  double bound;
};

Costs costs_of(const BallWay& way, const Box& box) {
  const auto along = [&](Eigen::Index axis) {
    return way.along(axis, box.min()[axis], box.max()[axis]);
  };
  return {way.total(along(0), along(1), along(2)), way.bound(along(0), along(1), along(2))};
}

bool is_passed_by(double cost, const BallWay& way) { return cost > way.length_m(); }

/// Otherwise a search along a long way would test everything beside it.
TEST(BallWay, ItsBoundKnowsOfMostBoxesThatTheyArePassedByHoweverLongTheWay) {
  testing::Random random(kCostsSeed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const double length_m : {10.0, 1e2, 1e4, 1e7}) {
    int passed = 0;
    int unknown = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      const Vec3 corner(20.0 * share(random), 20.0 * share(random), 20.0 * share(random));
      const double edge_m = std::exp2(std::floor(8.0 * share(random)) - 3.0);
      const Box box(corner, corner + Vec3::Constant(edge_m));
      const Vec3 near(60.0 * share(random), 60.0 * share(random), 60.0 * share(random));
      const Vec3 direction(normal(random), normal(random), normal(random));
      const double before = share(random);
      const BallWay way(near - before * length_m * direction,
                        near + (1.0 - before) * length_m * direction, share(random));
      const Costs costs = costs_of(way, box);
      ASSERT_LE(costs.bound, costs.total) << "trial " << trial;
      if (!is_passed_by(costs.total, way)) continue;
      ++passed;
      unknown += is_passed_by(costs.bound, way) ? 0 : 1;
    }
    ASSERT_GT(passed, 1000);
    EXPECT_LT(unknown, passed / 20) << length_m << " m";
  }
}

}  // namespace
}  // namespace camway::scene
