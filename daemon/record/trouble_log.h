// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/service/log/log.h"

namespace camway::record {

/// Tells the log of the daemon that events are missing in a recording: once when the trouble
/// begins, now and then while it lasts, and once when it is over. A disk that has room for a moment
/// every second is one trouble, and makes as few lines as one that stays full.
/// Not thread-safe, but for `reason`.
class TroubleLog {
 public:
  using Clock = std::chrono::steady_clock;

  struct Times {
    /// Time without a failure after which the trouble is over.
    std::chrono::milliseconds calm{30'000};
    /// Least time between two lines while it lasts.
    std::chrono::milliseconds reminder{600'000};
  };

  TroubleLog(std::shared_ptr<service::Log> log, const Times& times)
      : log_(std::move(log)), times_(times) {}

  /// Notes that something could not be written.
  void failed(std::string_view reason, Clock::time_point now = Clock::now());
  /// Counts events that are not recorded.
  void lost(std::uint64_t messages, std::uint64_t changes);
  /// Notes that all that waited was written.
  void succeeded(Clock::time_point now = Clock::now());
  /// Returns the last reason while the trouble lasts, else nothing: as the log tells it, not of one
  /// write. A disk at its limit has room for small events between two that find none. Thread-safe.
  [[nodiscard]] std::string reason() const {
    const std::lock_guard lock(mutex_);
    return reason_;
  }
  /// Tells of a trouble that is not over at the end of the recording.
  void finish();

 private:
  void set_reason(std::string_view reason);

  std::shared_ptr<service::Log> log_;
  Times times_;
  bool is_trouble_ = false;
  std::uint64_t failures_ = 0;  ///< since the trouble began
  std::uint64_t messages_ = 0;  ///< messages not recorded since the trouble began
  std::uint64_t changes_ = 0;   ///< changes not recorded since the trouble began
  mutable std::mutex mutex_;    ///< guards `reason_`
  std::string reason_;          ///< of the last failure of this trouble
  Clock::time_point failed_at_{};
  Clock::time_point told_at_{};
};

}  // namespace camway::record
