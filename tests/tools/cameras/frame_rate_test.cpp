// SPDX-License-Identifier: MIT
#include "tools/cameras/frame_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/random.h"

namespace camway::tools {
namespace {

using testing::Random;

constexpr std::uint64_t kRateSeed = 20260719;

std::vector<double> times_at(double fps, int frames, double begin_s, double rounding_s) {
  std::vector<double> times_s;
  for (int i = 0; i < frames; ++i) {
    const double time_s = begin_s + i / fps;
    times_s.push_back(rounding_s > 0.0 ? std::round(time_s / rounding_s) * rounding_s : time_s);
  }
  return times_s;
}

TEST(FrameRate, IsThatOfRoundedTimes) {
  Random random(kRateSeed);
  for (const double fps : {24000.0 / 1001.0, 24.0, 25.0, 30000.0 / 1001.0, 30.0, 48.0, 50.0,
                           60000.0 / 1001.0, 60.0, 120.0, 10.0, 20.0, 200.0}) {
    for (const double rounding_s : {0.0, 1e-6, 1e-4}) {
      const double begin_s = random.chance(0.5) ? 0.0 : random.uniform(0.0, 1000.0);
      const int frames = random.integer(100, 400);
      EXPECT_EQ(rate_of_times(times_at(fps, frames, begin_s, rounding_s)), fps)
          << rounding_s << " " << frames;
    }
  }
}

TEST(FrameRate, IsUsualWhereKeysAreFramesApart) {
  EXPECT_EQ(rate_of_times(std::vector{0.0, 1.0, 2.0}), 24.0);
  EXPECT_EQ(rate_of_times(std::vector{0.0, 0.04, 0.4}), 25.0);
  EXPECT_EQ(rate_of_times(std::vector{5.0, 5.0 + 1001.0 / 24000.0 * 7, 6.001}), 24000.0 / 1001.0);
}

TEST(FrameRate, IsNoneOfIrregularTimes) {
  EXPECT_EQ(rate_of_times(std::vector{0.0, 0.1234567, 0.2718281, 0.3141592}), std::nullopt);
  EXPECT_EQ(rate_of_times(std::vector{1.0}), std::nullopt);
}

}  // namespace
}  // namespace camway::tools
