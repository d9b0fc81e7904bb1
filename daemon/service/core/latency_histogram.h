// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include <camway/latency_t.hpp>

#include "lcmtypes/wire/latency_buckets.h"

namespace camway::service {

/// How long something took, counted in buckets of a logarithmic scale: constant memory, whatever
/// comes. For one thread at a time.
class LatencyHistogram {
 public:
  /// Takes in a duration; what is negative or not a number counts as 0.
  void add(double seconds);

  [[nodiscard]] latency_t to_wire() const;

 private:
  std::array<std::int64_t, wire::kLatencyBuckets> counts_{};
  std::int64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace camway::service
