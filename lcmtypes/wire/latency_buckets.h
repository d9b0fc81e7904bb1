// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace camway::wire {

/// Number of buckets of a `latency_t`: four for each factor of 2, so a quantile is known to a
/// fifth.
inline constexpr std::size_t kLatencyBuckets = 96;
inline constexpr std::size_t kLatencyBucketsPerDoubling = 4;

/// Returns the upper bound of the durations in a bucket: from 10 us to two minutes, and infinity
/// for the last bucket. [Limit: bucket < kLatencyBuckets] [Units: seconds]
inline double latency_bound_s(std::size_t bucket) {
  constexpr double kShortest_s = 1e-5;
  if (bucket + 1 >= kLatencyBuckets) return std::numeric_limits<double>::infinity();
  return kShortest_s *
         std::exp2(static_cast<double>(bucket) / static_cast<double>(kLatencyBucketsPerDoubling));
}

}  // namespace camway::wire
