// SPDX-License-Identifier: MIT
#pragma once

#include <spdlog/logger.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace camway::service {

/// Warnings of one kind, at most one line in a period, so that a peer that sends rubbish cannot
/// fill the disk. For one thread at a time.
class Warnings {
 public:
  using Clock = std::chrono::steady_clock;

  Warnings(std::shared_ptr<spdlog::logger> log, Clock::duration period)
      : log_(std::move(log)), period_(period) {}

  /// Logs `text`, with the number of warnings left out since the last line, or only counts it.
  void warn(std::string_view text, Clock::time_point now = Clock::now());

  [[nodiscard]] std::int64_t total() const { return total_; }

 private:
  std::shared_ptr<spdlog::logger> log_;
  Clock::duration period_;
  Clock::time_point next_line_{};
  std::int64_t left_out_ = 0;
  std::int64_t total_ = 0;
};

}  // namespace camway::service
