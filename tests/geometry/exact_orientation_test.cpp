// SPDX-License-Identifier: MIT
#include "daemon/geometry/exact_orientation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "daemon/geometry/rounding.h"
#include "tests/support/random.h"
#include "tests/support/sanitizer.h"
#include "tests/support/scenes.h"

namespace camway::geometry {
namespace {

/// Wide enough for every product of three differences of the coordinates below to be exact.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<
    1000, boost::multiprecision::digit_base_2, void, std::int32_t, -100000, 100000>>;

int oracle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Wide area =
      (Wide(b.x()) - a.x()) * (Wide(c.y()) - a.y()) - (Wide(b.y()) - a.y()) * (Wide(c.x()) - a.x());
  return area.sign();
}

int oracle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  std::array<std::array<Wide, 3>, 3> m;
  for (Eigen::Index k = 0; k < 3; ++k) {
    m[0][static_cast<std::size_t>(k)] = Wide(b[k]) - a[k];
    m[1][static_cast<std::size_t>(k)] = Wide(c[k]) - a[k];
    m[2][static_cast<std::size_t>(k)] = Wide(p[k]) - a[k];
  }
  const Wide volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                      m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                      m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return volume.sign();
}

TEST(ExactOrientation, KnownSigns) {
  EXPECT_EQ(orientation(Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)), 1);
  EXPECT_EQ(orientation(Vec2(0, 0), Vec2(0, 1), Vec2(1, 0)), -1);
  EXPECT_EQ(orientation(Vec2(0.1, 0.1), Vec2(0.2, 0.2), Vec2(0.7, 0.7)), 0);
  EXPECT_EQ(orientation(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5, 5, 1)), 1);
  EXPECT_EQ(orientation(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5, 5, -0x1p-300)), -1);
  EXPECT_EQ(orientation(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5, 5, 0)), 0);
}

// Points on a line or plane, moved by a few units in the last place, near and far from the origin,
// at every size that a kernel accepts.
TEST(ExactOrientation, NearlyDegenerateAgainstWideArithmetic) {
  testing::Random random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::array<int, 3> seen{};
  for (int i = 0; i < testing::runs(20'000); ++i) {
    const double size = std::exp2(std::uniform_int_distribution<int>(-150, 150)(random));
    const auto vec = [&] { return Vec3(size * Vec3(unit(random), unit(random), unit(random))); };
    const auto nudged = [&](Vec3 v) {
      for (double& x : v) {
        for (auto left = random() % 3; left > 0; --left)
          x = std::nextafter(x, random() % 2 ? 9e99 : 0.0);
      }
      return v;
    };
    const Vec3 a = vec();
    const Vec3 b = random() % 8 == 0 ? a : vec();
    const Vec3 c = random() % 2 == 0 ? vec() : nudged(a + unit(random) * (b - a));
    const Vec3 p = nudged(a + unit(random) * (b - a) + unit(random) * (c - a));
    const int sign = orientation(a, b, c, p);
    ASSERT_EQ(sign, oracle(a, b, c, p)) << i;
    ++seen[static_cast<std::size_t>(sign + 1)];
    ASSERT_EQ(orientation(b, a, c, p), -sign) << i;
    ASSERT_EQ(orientation(a, c, p, b), sign) << i;
    const Vec2 a2 = a.head<2>();
    const Vec2 b2 = b.head<2>();
    const Vec2 c2 = c.head<2>();
    ASSERT_EQ(orientation(a2, b2, c2), oracle(a2, b2, c2)) << i;
    ASSERT_EQ(orientation(b2, c2, a2), orientation(a2, b2, c2)) << i;
  }
  for (const int count : seen) EXPECT_GT(count, testing::runs(500));
}

// Products underflow or are as large as possible.
TEST(ExactOrientation, TinyAndHugeCoordinates) {
  const double tiny = 0x1p-1074;
  const double huge = kLargestCoordinate_m / 2;
  EXPECT_EQ(orientation(Vec2(0, 0), Vec2(tiny, 0), Vec2(0, tiny)), 1);
  EXPECT_EQ(orientation(Vec2(tiny, tiny), Vec2(2 * tiny, 2 * tiny), Vec2(3 * tiny, 3 * tiny)), 0);
  EXPECT_EQ(orientation(Vec3(0, 0, 0), Vec3(tiny, 0, 0), Vec3(0, tiny, 0), Vec3(0, 0, tiny)), 1);
  EXPECT_EQ(orientation(Vec3(0, 0, 0), Vec3(tiny, 0, 0), Vec3(0, tiny, 0), Vec3(0, 0, -huge)), -1);
  EXPECT_EQ(orientation(Vec3(-huge, 0, 0), Vec3(huge, 0, 0), Vec3(0, huge, tiny), Vec3(0, 0, tiny)),
            1);
}

}  // namespace
}  // namespace camway::geometry
