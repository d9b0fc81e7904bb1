// SPDX-License-Identifier: MIT
#include <camway/daemon_status.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/random.h"

namespace camway {
namespace {

constexpr std::uint64_t kStatusSeed = 20261122;
/// The documented scale, computed independently: bucket i ends at 10 us * 2^(i/4).
constexpr double kRatio = 1.189207115002721;

Latency counted(const std::vector<double>& seconds) {
  Latency latency;
  latency.buckets.resize(95);
  for (const double value : seconds) {
    const double bucket = std::ceil(4.0 * std::log2(value / 1e-5));
    ++latency.buckets[static_cast<std::size_t>(std::max(bucket, 0.0))];
    ++latency.count;
  }
  return latency;
}

TEST(Latency, QuantilesAreRightToAFifth) {
  testing::Random random(kStatusSeed);
  std::uniform_real_distribution<double> exponent(-16.0, 6.0);
  for (const std::size_t size : {1U, 2U, 10U, 1000U}) {
    std::vector<double> seconds(size);
    std::generate(seconds.begin(), seconds.end(), [&] { return std::exp2(exponent(random)); });
    const Latency latency = counted(seconds);
    std::sort(seconds.begin(), seconds.end());
    for (const double q : {0.0, 0.1, 0.5, 0.99, 0.999, 1.0}) {
      const double rank = std::ceil(q * static_cast<double>(size));
      const double exact = seconds[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
      EXPECT_GE(latency.quantile_s(q), exact * (1 - 1e-12)) << "seed " << kStatusSeed << " q " << q;
      EXPECT_LE(latency.quantile_s(q), exact * kRatio * (1 + 1e-12)) << q << " of " << size;
    }
  }
}

TEST(Latency, NothingCountedIsZeroAndTheLongestIsFinite) {
  EXPECT_EQ(Latency{}.quantile_s(0.5), 0.0);
  Latency latency;
  latency.buckets.resize(96);
  latency.buckets[95] = 1;
  EXPECT_NEAR(latency.quantile_s(0.5), 1e-5 * std::exp2(94 / 4.0), 1e-9);
}

TEST(Latency, SinceIsWhatCameBetween) {
  const Latency before{2, 0.5, {1, 1}};
  const Latency after{5, 0.9, {1, 3, 0, 1}};
  const Latency between = after.since(before);
  EXPECT_EQ(between.count, 3);
  EXPECT_DOUBLE_EQ(between.sum_s, 0.4);
  EXPECT_EQ(between.buckets, (std::vector<std::int64_t>{0, 2, 0, 1}));
}

}  // namespace
}  // namespace camway
