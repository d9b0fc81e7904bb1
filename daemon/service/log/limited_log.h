// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/base/token_bucket.h"
#include "daemon/service/log/log.h"

namespace camway::service {

/// Log for lines of one kind that clients can provoke, limited by a `base::TokenBucket` so that
/// they cannot fill the disk. Lines beyond the limit are counted; their number is logged when the
/// limit permits a line again, but at most once per `kReportPeriod`. Not thread-safe.
class LimitedLog {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kReportPeriod{10};

  struct Limits {
    double lines_per_s = 10.0;  ///< [Limit: 0 < value]
    double burst_lines = 50.0;  ///< [Limit: 1 <= value]
  };

  /// `kind` names the lines in the report of suppressed lines, e.g. "answers".
  LimitedLog(std::shared_ptr<Log> log, LogLevel level, std::string kind, const Limits& limits)
      : log_(std::move(log)),
        level_(level),
        kind_(std::move(kind)),
        bucket_(limits.lines_per_s, limits.burst_lines) {}

  /// Logs a line, or only counts it. Returns whether it was logged.
  bool write(std::string_view event, LogFields fields = {}, Clock::time_point now = Clock::now());

  /// Logs how many lines were suppressed since the last report, if there are any, a report is due
  /// and the limit permits a line. The owner must call it from time to time, because after the last
  /// suppressed line no further one may follow.
  void report_suppressed(Clock::time_point now = Clock::now());

 private:
  std::shared_ptr<Log> log_;
  LogLevel level_;
  std::string kind_;
  base::TokenBucket bucket_;
  std::int64_t suppressed_ = 0;
  Clock::time_point report_at_ = Clock::time_point::min();  ///< earliest time of the next report
};

/// The logs of the service for lines that clients can provoke. All have equal limits, each for
/// itself.
/// Not thread-safe.
struct LimitedLogs {
  LimitedLogs(const std::shared_ptr<Log>& log, const LimitedLog::Limits& limits);

  /// Calls `LimitedLog::report_suppressed` for all kinds.
  void report_suppressed(LimitedLog::Clock::time_point now);

  LimitedLog answers;    ///< answers to plan requests
  LimitedLog occupancy;  ///< answers to occupancy queries
  LimitedLog scenes;     ///< answers to scene requests
  LimitedLog watches;    ///< watched paths that collide or are no longer watched
  LimitedLog malformed;  ///< messages that could not be read
  LimitedLog refused;    ///< requests for which there was no room
  LimitedLog trouble;    ///< faults of the daemon itself, perhaps from too much work
};

}  // namespace camway::service
