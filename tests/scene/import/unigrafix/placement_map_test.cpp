// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/placement_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/random.h"

namespace camway::scene::unigrafix {
namespace {

using camway::testing::Random;
/// The oracle: the same maps with a mantissa that is 11 bits longer.
using Exact = std::array<std::array<long double, 4>, 3>;
using ExactPoint = std::array<long double, 3>;

constexpr std::uint64_t kSeed = 19940501;

ExactPoint applied(const Exact& map, const ExactPoint& p) {
  ExactPoint result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = map[i][0] * p[0] + map[i][1] * p[1] + map[i][2] * p[2] + map[i][3];
  }
  return result;
}

ExactPoint unit(const Point& axis) {
  const long double x = axis[0];
  const long double y = axis[1];
  const long double z = axis[2];
  const long double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

Exact rotation(const Point& axis, double angle_deg) {
  const ExactPoint u = unit(axis);
  const long double angle_rad = std::fmod(static_cast<long double>(angle_deg), 360.0L) *
                                std::numbers::pi_v<long double> / 180;
  const long double sine = std::sin(angle_rad);
  const long double cosine = std::cos(angle_rad);
  Exact map{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      map[i][j] = u[i] * u[j] * (1 - cosine) + (i == j ? cosine : 0.0L);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    map[i][j] -= u[k] * sine;
    map[j][i] += u[k] * sine;
  }
  return map;
}

Exact scaling_along(const Point& axis, double factor) {
  const ExactPoint u = unit(axis);
  Exact map{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      map[i][j] = (i == j ? 1.0L : 0.0L) + (static_cast<long double>(factor) - 1) * u[i] * u[j];
    }
  }
  return map;
}

/// A random map and the same for the oracle.
struct Pair {
  PlacementMap map;
  Exact exact{};
};

Pair random_pair(Random& random) {
  const Point axis = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(0.1, 3)};
  switch (random.integer(0, 3)) {
    case 0: {
      const double angle_deg = random.uniform(-1000, 1000);
      return {PlacementMap::rotation(axis, angle_deg), rotation(axis, angle_deg)};
    }
    case 1: {
      const double factor = random.uniform(-4, 4);
      return {PlacementMap::scaling_along(axis, factor), scaling_along(axis, factor)};
    }
    case 2: {
      const Point offset = {random.uniform(-1e4, 1e4), axis[0], axis[1]};
      return {PlacementMap::translation(offset),
              {{{1, 0, 0, offset[0]}, {0, 1, 0, offset[1]}, {0, 0, 1, offset[2]}}}};
    }
    default:
      return {PlacementMap::scaling(axis),
              {{{axis[0], 0, 0, 0}, {0, axis[1], 0, 0}, {0, 0, axis[2], 0}}}};
  }
}

TEST(PlacementMap, IsWithinItsBoundOfTheExactMap) {
  Random random(kSeed);
  double largest_share = 0.0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const Point point = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    ExactPoint exact = {point[0], point[1], point[2]};
    PlacementMap map;
    for (int i = random.integer(1, 8); i > 0; --i) {
      const Pair next = random_pair(random);
      map = map.then(next.map);
      exact = applied(next.exact, exact);
    }
    const Point result = map.apply(point);
    const double bound = map.rounding({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto error = static_cast<double>(std::abs(exact[k] - result[k]));
      ASSERT_LE(error, bound) << "trial " << trial << " of seed " << kSeed;
      largest_share = std::max(largest_share, error / bound);
    }
  }
  // The bound says something: it is not a thousand times what happens.
  EXPECT_GT(largest_share, 1e-3);
}

TEST(PlacementMap, TurnsByQuartersExactly) {
  Random random(kSeed);
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const Point p = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    const Point turned = PlacementMap::rotation({0, 0, 1}, 90.0 * quarter).apply(p);
    const int steps = ((quarter % 4) + 4) % 4;
    const std::array<Point, 4> expected = {
        {{p[0], p[1], p[2]}, {-p[1], p[0], p[2]}, {-p[0], -p[1], p[2]}, {p[1], -p[0], p[2]}}};
    EXPECT_EQ(turned, expected[static_cast<std::size_t>(steps)]) << quarter;
  }
}

TEST(PlacementMap, KnowsWhetherItMirrors) {
  EXPECT_FALSE(PlacementMap().mirrors());
  EXPECT_FALSE(PlacementMap::rotation({1, 2, 3}, 100).mirrors());
  EXPECT_TRUE(PlacementMap::scaling_along({1, 2, 3}, -1).mirrors());
  EXPECT_FALSE(PlacementMap::scaling({-1, -1, 1}).mirrors());
}

}  // namespace
}  // namespace camway::scene::unigrafix
