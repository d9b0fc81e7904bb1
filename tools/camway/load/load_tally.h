// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/planning/result.h"

namespace camway::tools {

/// A request that is sent again and again, and what planning it here gives.
struct LoadQuestion {
  std::string name;
  PlanRequest request;
  planning::PlanResult expected;
};

/// Whether the daemon's answer is what planning here gave, bit for bit: status, path, keyframes,
/// collisions and certificate.
bool is_expected(const planning::PlanResult& expected, const PlanResponse& answer);

/// What came of many requests. For one thread at a time.
struct LoadTally {
  std::int64_t asked = 0;
  std::int64_t answered = 0;  ///< as planning here did
  std::int64_t refused = 0;   ///< overloaded or timeout: the daemon said that it had no time
  std::int64_t wrong = 0;     ///< another answer than planning here gave
  std::int64_t lost = 0;      ///< no answer at all
  std::int64_t retries = 0;   ///< repetitions of requests
  std::map<std::string, std::int64_t> by_status;
  std::vector<float> latency_ms;        ///< of what was answered, from the call to its return
  std::vector<float> overhead_ms;       ///< the same without planning: travel, queue, conversions
  std::vector<std::string> complaints;  ///< about the first that were wrong or lost

  void add(const LoadQuestion& question, const PlanResponse& answer);
  void add(const LoadTally& other);

  static constexpr std::size_t kMostComplaints = 5;
};

/// The resident memory of a process over time.
struct MemorySample {
  double time_s = 0.0;
  double resident_mb = 0.0;
};

/// Resident memory in units of 1e6 bytes; 0 if there is no such process.
double resident_mb(int pid);

/// By how much memory grew after the warm-up: the median of the last tenth of the samples over that
/// of the first, less 1. 0 where fewer than ten samples are left.
double memory_growth(const std::vector<MemorySample>& samples, double warm_up_s);

/// Times of a run in order.
struct Percentiles {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};
/// By nearest rank; all 0 of nothing.
Percentiles percentiles(std::vector<float> values);

}  // namespace camway::tools
