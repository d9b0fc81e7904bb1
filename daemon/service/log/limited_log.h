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

/// Lines of one kind that somebody else can provoke, limited by a `TokenBucket` so that he cannot
/// fill the disk: so many at once, then so many a second. What is left out is counted, and the
/// number said when there is room again, but not in each pause of a flood: at most every
/// `kTellEvery`. For one thread at a time.
class LimitedLog {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kTellEvery{10};

  struct Limits {
    double lines_per_s = 10.0;  ///< [Limit: 0 < value]
    double burst_lines = 50.0;  ///< [Limit: 1 <= value]
  };

  /// `kind` is what the lines are called where some were left out: "answers".
  LimitedLog(std::shared_ptr<Log> log, LogLevel level, std::string kind, const Limits& limits)
      : log_(std::move(log)),
        level_(level),
        kind_(std::move(kind)),
        bucket_(limits.lines_per_s, limits.burst_lines) {}

  /// Logs a line, or only counts it.
  void write(std::string_view event, LogFields facts = {}, Clock::time_point now = Clock::now());

  /// Says what was left out since that was last said, if anything was, it is time to, and there is
  /// room. To be called now and then, for there may be no next line.
  void tell_left_out(Clock::time_point now = Clock::now());

 private:
  std::shared_ptr<Log> log_;
  LogLevel level_;
  std::string kind_;
  TokenBucket bucket_;
  std::int64_t left_out_ = 0;
  Clock::time_point tell_at_ = Clock::time_point::min();  ///< not before
};

/// The lines of the service that clients can provoke, each kind within the same limits of its own.
struct LimitedLogs {
  LimitedLogs(const std::shared_ptr<Log>& log, const LimitedLog::Limits& limits);

  /// Of all kinds; see there.
  void tell_left_out(LimitedLog::Clock::time_point now);

  LimitedLog answers;    ///< of plan requests
  LimitedLog occupancy;  ///< answers about it
  LimitedLog scenes;     ///< what was done to them
  LimitedLog watches;    ///< watched paths that collide or are not watched any more
  LimitedLog malformed;  ///< messages that could not be read
  LimitedLog refused;    ///< requests for which there was no room
  LimitedLog trouble;    ///< of the daemon itself, which may come from too much work
};

}  // namespace camway::service
