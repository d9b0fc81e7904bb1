// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "daemon/base/progress.h"

namespace camway::collision {

/// The only clock that planning reads: how long it has run, and whether it must stop, because time
/// is up or the client cancelled. An answer depends on the clock only if the deadline strikes. A
/// value type; deadlines made from one another share whether they struck. Thread-safe.
class Deadline {
 public:
  /// Strikes `seconds` from now. [Limit: 0 <= value]
  static Deadline after_s(double seconds);

  /// Never strikes.
  static Deadline never();

  /// For tests: replaces the clock by a counter, which advances by a millisecond each time that
  /// this deadline or one made from it reads it, and strikes at the read after `looks` of them. So
  /// tests can cut planning short at any place. [Limit: 0 <= value]
  static Deadline after_looks(int looks);

  /// A deadline that also strikes when `stop` is requested, and passes on the progress of planning.
  [[nodiscard]] Deadline watched(std::stop_token stop, std::shared_ptr<Progress> progress) const;

  /// A deadline that does not strike before `seconds` from now, unless it is stopped.
  [[nodiscard]] Deadline not_before_s(double seconds) const;

  /// A deadline that strikes `seconds` sooner. [Limit: 0 <= value]
  [[nodiscard]] Deadline sooner_by_s(double seconds) const;

  /// A deadline that strikes after `share` of the remaining time. [Limit: 0 <= value <= 1]
  [[nodiscard]] Deadline share_of_rest(double share) const;

  [[nodiscard]] bool passed() const;

  /// Whether a stop was requested, whatever the time.
  [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }

  /// The remaining time, 0 once the deadline passed or was stopped.
  [[nodiscard]] double remaining_s() const;

  /// Whether at least `seconds` remain.
  [[nodiscard]] bool leaves_s(double seconds) const;

  /// Whether `passed` ever returned true or `leaves_s` false, for this deadline or any that was
  /// made from the same one. If not, the answer does not depend on the clock.
  [[nodiscard]] bool struck() const { return struck_->load(std::memory_order_relaxed); }

  /// Milliseconds since the deadline, or the one that it was made from, was created.
  [[nodiscard]] double elapsed_ms() const;

  /// Reports progress to the watcher, if there is one.
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

}  // namespace camway::collision
