// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/service/core/latency_histogram.h"

namespace camway::service {

/// Numbers of answers by status. A status beyond the range is not counted.
class AnswerCounts {
 public:
  static constexpr std::size_t kStatuses = 16;

  void add(std::int32_t status) {
    const auto place = static_cast<std::size_t>(status);
    if (status >= 0 && place < kStatuses) ++counts_.at(place);
  }
  [[nodiscard]] const std::array<std::int64_t, kStatuses>& counts() const { return counts_; }

 private:
  std::array<std::int64_t, kStatuses> counts_{};
};

/// Numbers since the start; `status_t` describes each.
/// Not thread-safe: for the loop thread.
struct Counters {
  std::int64_t answered = 0;
  std::int64_t repeated = 0;
  std::int64_t cache_hits = 0;
  std::int64_t overloaded = 0;
  std::int64_t malformed = 0;
  std::int64_t request_pages_asked_again = 0;
  std::int64_t answer_pages_asked_again = 0;
  std::int64_t scene_changes = 0;
  std::int64_t broken_paths = 0;
  std::int32_t watched_paths = 0;  ///< present number
  AnswerCounts plan_answers;
  AnswerCounts occupancy_answers;
  AnswerCounts scene_answers;
  LatencyHistogram receipt_to_answer;
  LatencyHistogram waiting;
  LatencyHistogram planning;
};

}  // namespace camway::service
