// SPDX-License-Identifier: MIT
#include "daemon/service/core/latency_histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/support/random.h"

namespace camway::service {
namespace {

constexpr std::uint64_t kHistogramSeed = 20261122;

TEST(LatencyHistogram, EveryDurationIsWithinTheBoundsOfItsBucket) {
  testing::Random random(kHistogramSeed);
  // From below the first bound to above the last.
  std::uniform_real_distribution<double> exponent(-20.0, 10.0);
  for (int trial = 0; trial < 10'000; ++trial) {
    const double seconds = std::exp2(exponent(random));
    LatencyHistogram histogram;
    histogram.add(seconds);
    const latency_t wire = histogram.to_wire();
    ASSERT_GE(wire.num_buckets, 1) << seconds << " s";
    const auto bucket = wire.buckets.size() - 1;
    EXPECT_EQ(wire.buckets[bucket], 1);
    EXPECT_LE(seconds, wire::latency_bound_s(bucket));
    if (bucket > 0) {
      EXPECT_GT(seconds, wire::latency_bound_s(bucket - 1));
    }
  }
}

TEST(LatencyHistogram, BoundsBelongToTheBucketTheyEnd) {
  for (std::size_t i = 0; i + 1 < wire::kLatencyBuckets; ++i) {
    LatencyHistogram histogram;
    histogram.add(wire::latency_bound_s(i));
    EXPECT_EQ(histogram.to_wire().buckets.size(), i + 1);
    histogram.add(std::nextafter(wire::latency_bound_s(i), 1e9));
    EXPECT_EQ(histogram.to_wire().buckets.size(), i + 2);
  }
}

TEST(LatencyHistogram, CountsEverythingAndSendsNoMoreBucketsThanItNeeds) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.to_wire().num_buckets, 0);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double odd : {0.0, -1.0, std::nan("")}) histogram.add(odd);
  EXPECT_EQ(histogram.to_wire().num_buckets, 1);
  EXPECT_EQ(histogram.to_wire().sum_s, 0.0);
  histogram.add(infinity);
  const latency_t wire = histogram.to_wire();
  EXPECT_EQ(wire.buckets.size(), wire::kLatencyBuckets);
  EXPECT_EQ(wire.count, 4);
  EXPECT_EQ(std::accumulate(wire.buckets.begin(), wire.buckets.end(), std::int64_t{0}), 4);
}

}  // namespace
}  // namespace camway::service
