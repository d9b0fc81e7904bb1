// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include <camway/latency_t.hpp>

#include "lcmtypes/wire/latency_buckets.h"

namespace camway::service {

/// Histogram of durations with buckets on a logarithmic scale. Takes constant memory.
/// Not thread-safe.
class LatencyHistogram {
 public:
  /// Adds a duration; a negative one or NaN counts as 0.
  void add(double seconds);

  [[nodiscard]] latency_t to_wire() const;

 private:
  std::array<std::int64_t, wire::kLatencyBuckets> counts_{};
  std::int64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace camway::service
