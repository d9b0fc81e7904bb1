// SPDX-License-Identifier: MIT
#include <camway/daemon_status.h>

#include <algorithm>

#include "lcmtypes/wire/latency_buckets.h"

namespace camway {

double Latency::quantile_s(double q) const {
  std::int64_t all = 0;
  for (const std::int64_t bucket : buckets) all += bucket;
  if (all <= 0) return 0.0;
  const double rank = std::clamp(q, 0.0, 1.0) * static_cast<double>(all);
  std::int64_t below = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    if (buckets[i] <= 0) continue;
    last = i;
    below += buckets[i];
    if (static_cast<double>(below) >= rank) break;
  }
  return wire::latency_bound_s(std::min(last, wire::kLatencyBuckets - 2));
}

Latency Latency::since(const Latency& before) const {
  Latency difference = *this;
  difference.count -= before.count;
  difference.sum_s -= before.sum_s;
  const std::size_t common = std::min(buckets.size(), before.buckets.size());
  for (std::size_t i = 0; i < common; ++i) difference.buckets[i] -= before.buckets[i];
  return difference;
}

}  // namespace camway
