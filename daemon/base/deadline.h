// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "daemon/base/progress.h"

namespace camway::base {

/// The only clock that planning reads. It tells how long planning has run, and whether it must stop
/// because the time is up or a stop was requested. An answer depends on the clock only if the
/// deadline *strikes*: if `passed` returns true or `leaves_s` returns false. A value type. A
/// deadline that is made from another one shares with it whether one of the two struck.
/// Thread-safe.
class Deadline {
 public:
  /// Returns a deadline that strikes `seconds` from now. [Limit: 0 <= value]
  static Deadline after_s(double seconds);

  /// Returns a deadline that never strikes.
  static Deadline never();

  /// For tests, which can so end planning at any place. Returns a deadline whose clock is a
  /// counter. The counter advances by a millisecond each time that this deadline, or one made from
  /// it, reads it. The deadline strikes at the first read after `looks` reads. [Limit: 0 <= looks]
  static Deadline after_looks(int looks);

  /// Returns a deadline that also strikes when `stop` is requested, and that writes the progress of
  /// planning to `progress`.
  [[nodiscard]] Deadline watched(std::stop_token stop, std::shared_ptr<Progress> progress) const;

  /// Returns a deadline that does not strike before `seconds` from now, unless a stop is requested.
  [[nodiscard]] Deadline not_before_s(double seconds) const;

  /// Returns a deadline that strikes `seconds` sooner. [Limit: 0 <= value]
  [[nodiscard]] Deadline sooner_by_s(double seconds) const;

  /// Returns a deadline that strikes after `share` of the remaining time. [Limit: 0 <= value <= 1]
  [[nodiscard]] Deadline share_of_rest(double share) const;

  /// Returns whether the time is up or a stop was requested. If so, the deadline has struck.
  [[nodiscard]] bool passed() const;

  /// Returns whether a stop was requested.
  [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }

  /// Returns the remaining time; 0 once the deadline passed or a stop was requested.
  [[nodiscard]] double remaining_s() const;

  /// Returns whether at least `seconds` remain. If not, the deadline has struck.
  [[nodiscard]] bool leaves_s(double seconds) const;

  /// Returns whether this deadline struck, or any that was made from the same one. If not, the
  /// answer does not depend on the clock.
  [[nodiscard]] bool struck() const { return struck_->load(std::memory_order_relaxed); }

  /// Returns the milliseconds since this deadline, or the one that it was made from, was created.
  [[nodiscard]] double elapsed_ms() const;

  /// Writes to the progress of `watched`, if there is one.
  void report(Progress::Stage stage) const;
  void report_collisions(std::size_t found, std::size_t corrected) const;

 private:
  using Clock = std::chrono::steady_clock;

  explicit Deadline(Clock::duration budget);

  /// Returns `is_over`, and records that the deadline struck if it is true.
  [[nodiscard]] bool told(bool is_over) const;

  [[nodiscard]] Clock::time_point now() const;

  Clock::time_point start_;
  Clock::duration budget_;
  std::stop_token stop_;
  std::shared_ptr<Progress> progress_;
  std::shared_ptr<std::atomic<bool>> struck_ = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::atomic<std::int64_t>> looks_;  ///< reads of the test clock; or null
};

}  // namespace camway::base
