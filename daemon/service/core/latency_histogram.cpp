// SPDX-License-Identifier: MIT
#include "daemon/service/core/latency_histogram.h"

#include <algorithm>
#include <iterator>

namespace camway::service {
namespace {

using Bounds = std::array<double, wire::kLatencyBuckets>;

Bounds bounds_s() {
  Bounds bounds{};
  for (std::size_t i = 0; i < bounds.size(); ++i) bounds.at(i) = wire::latency_bound_s(i);
  return bounds;
}

std::size_t bucket_of(double seconds) {
  static const Bounds kBounds = bounds_s();
  const auto* const found = std::lower_bound(kBounds.begin(), kBounds.end() - 1, seconds);
  return static_cast<std::size_t>(std::distance(kBounds.begin(), found));
}

}  // namespace

void LatencyHistogram::add(double seconds) {
  const double counted_s = seconds > 0.0 ? seconds : 0.0;
  ++counts_.at(bucket_of(counted_s));
  ++count_;
  sum_s_ += counted_s;
}

latency_t LatencyHistogram::to_wire() const {
  latency_t wire{};
  wire.count = count_;
  wire.sum_s = sum_s_;
  const auto last =
      std::find_if(counts_.rbegin(), counts_.rend(), [](std::int64_t count) { return count != 0; });
  wire.buckets.assign(counts_.begin(), last.base());
  wire.num_buckets = static_cast<std::int32_t>(wire.buckets.size());
  return wire;
}

}  // namespace camway::service
