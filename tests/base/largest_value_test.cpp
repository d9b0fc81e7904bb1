// SPDX-License-Identifier: MIT
#include "daemon/base/largest_value.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace camway::base {
namespace {

constexpr std::array kPlaces = {-1.0, -0.4, 0.1, 0.5, 1.0};

TEST(LargestValue, IsFoundBetweenThePlaces) {
  for (const double peak : {-0.9, -0.2, 0.0, 0.3, 0.77}) {
    const auto parabola = [&](double x) { return 3.0 - (x - peak) * (x - peak); };
    // Sections end within a thousandth of two steps, where a parabola has fallen by its square.
    EXPECT_NEAR(largest_value(kPlaces, parabola), 3.0, 1e-6) << peak;
    const auto roof = [&](double x) { return 3.0 - std::abs(x - peak); };
    EXPECT_NEAR(largest_value(kPlaces, roof), 3.0, 1.2e-3) << peak;
  }
}

TEST(LargestValue, MayLieAtAnEnd) {
  EXPECT_EQ(largest_value(kPlaces, [](double x) { return 2.0 * x; }), 2.0);
  EXPECT_EQ(largest_value(kPlaces, [](double x) { return -x; }), 1.0);
  EXPECT_EQ(largest_value(std::array{4.0}, [](double x) { return x; }), 4.0);
}

}  // namespace
}  // namespace camway::base
