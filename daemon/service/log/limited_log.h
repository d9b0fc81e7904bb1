// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/service/log/log.h"
#include "daemon/service/log/token_bucket.h"

namespace camway::service {

/// Log for lines of one kind that clients can provoke, limited by a `TokenBucket` so that they
/// cannot fill the disk. Lines beyond the limit are counted; their number is logged when the limit
/// permits a line again, but at most every `kTellEvery`.
/// Not thread-safe.
class LimitedLog {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kTellEvery{10};

  struct Limits {
    double lines_per_s = 10.0;  ///< [Limit: 0 < value]
    double burst_lines = 50.0;  ///< [Limit: 1 <= value]
  };

  /// `kind` names the lines in the report of those left out: "answers".
  LimitedLog(std::shared_ptr<Log> log, LogLevel level, std::string kind, const Limits& limits)
      : log_(std::move(log)),
        level_(level),
        kind_(std::move(kind)),
        bucket_(limits.lines_per_s, limits.burst_lines) {}

  /// Logs a line, or only counts it.
  void write(std::string_view event, LogFields facts = {}, Clock::time_point now = Clock::now());

  /// Logs how many lines were left out since the last report, if there are any, a report is due and
  /// the limit permits a line. To be called now and then, since no further line may follow.
  void tell_left_out(Clock::time_point now = Clock::now());

 private:
  std::shared_ptr<Log> log_;
  LogLevel level_;
  std::string kind_;
  TokenBucket bucket_;
  std::int64_t left_out_ = 0;
  Clock::time_point tell_at_ = Clock::time_point::min();  ///< earliest time of the next report
};

/// The lines of the service that clients can provoke; each kind has the same limits, for itself.
struct LimitedLogs {
  LimitedLogs(const std::shared_ptr<Log>& log, const LimitedLog::Limits& limits);

  /// Calls `LimitedLog::tell_left_out` for all kinds.
  void tell_left_out(LimitedLog::Clock::time_point now);

  LimitedLog answers;    ///< answers to plan requests
  LimitedLog occupancy;  ///< answers to occupancy queries
  LimitedLog scenes;     ///< answers to scene requests
  LimitedLog watches;    ///< watched paths that collide or are no longer watched
  LimitedLog malformed;  ///< messages that could not be read
  LimitedLog refused;    ///< requests for which there was no room
  LimitedLog trouble;    ///< faults of the daemon itself, perhaps from too much work
};

}  // namespace camway::service
