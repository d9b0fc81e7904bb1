// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/planning/result/result.h"

namespace camway::tools {

/// A request that is sent repeatedly, and the result of planning it locally.
struct LoadRequest {
  std::string name;
  PlanRequest request;
  planning::PlanResult expected;
};

/// Returns whether the daemon's answer has the same bits as the local result in status, path,
/// keyframes, collisions and certificate.
bool is_expected(const planning::PlanResult& expected, const PlanResponse& answer);

/// The results of many requests. Not thread-safe.
struct LoadTally {
  std::int64_t asked = 0;
  std::int64_t answered = 0;  ///< answers equal to the local result
  std::int64_t refused = 0;   ///< answers overloaded or timeout: the daemon had no time
  std::int64_t wrong = 0;     ///< answers that differ from the local result
  std::int64_t lost = 0;      ///< requests without an answer
  std::int64_t retries = 0;   ///< repetitions of requests
  std::map<std::string, std::int64_t> by_status;
  std::map<std::string, std::string> invalid;  ///< requests answered `invalid`, and the reasons
  std::vector<float> latency_ms;               ///< time from call to return, of answered requests
  std::vector<float> overhead_ms;       ///< latency minus planning: transport, queue, conversions
  std::vector<std::string> complaints;  ///< texts about the first wrong or lost answers

  void add(const LoadRequest& sent, const PlanResponse& answer);
  void add(const LoadTally& other);

  static constexpr std::size_t kMostComplaints = 5;
};

/// The resident memory of a process over time.
struct MemorySample {
  double time_s = 0.0;
  double resident_mb = 0.0;
};

/// Returns the resident memory of a process; 0 if there is no such process. [Units: 1e6 bytes]
double resident_mb(int pid);

/// Returns the relative growth of memory after the warm-up: the median of the last tenth of the
/// samples, divided by the median of the first tenth, minus 1. Returns 0 for fewer than ten
/// samples.
double memory_growth(const std::vector<MemorySample>& samples, double warm_up_s);

/// Percentiles of the times of a run.
struct Percentiles {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};
/// Returns percentiles by nearest rank; all 0 for no values.
Percentiles percentiles(std::vector<float> values);

}  // namespace camway::tools
