// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "daemon/base/progress.h"

namespace camway::collision {

/// The only clock that planning sees: how long it has run, and whether it must stop, because time
/// is up or because nobody wants the result any more. A value type. An answer depends on it only if
/// it strikes.
class Deadline {
 public:
  /// Strikes `seconds` from now. [Limit: 0 <= value]
  static Deadline after_s(double seconds);

  /// Never strikes.
  static Deadline never();

  /// Strikes at the look after so many, by a clock that stands still but for a millisecond at each
  /// look at it, of this deadline and of all that are made of it: for tests of what an answer is
  /// that was cut short at any place. [Limit: 0 <= value]
  static Deadline after_looks(int looks);

  /// The same, that strikes as well when `stop` is requested, and hands on what planning reports.
  [[nodiscard]] Deadline watched(std::stop_token stop, std::shared_ptr<Progress> progress) const;

  /// The same, but not before `seconds` from now, unless it is told to stop.
  [[nodiscard]] Deadline not_before_s(double seconds) const;

  /// The same, that strikes so much sooner. [Limit: 0 <= value]
  [[nodiscard]] Deadline sooner_by_s(double seconds) const;

  /// The same, that strikes when `share` of what is left is over. [Limit: 0 <= value <= 1]
  [[nodiscard]] Deadline share_of_rest(double share) const;

  [[nodiscard]] bool passed() const;

  /// Whether somebody asked to stop, whatever the time.
  [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }

  /// What is left, 0 once it has passed.
  [[nodiscard]] double remaining_s() const;

  /// Whether so much is left.
  [[nodiscard]] bool leaves_s(double seconds) const;

  /// Whether somebody has been told that it passed, or leaves too little, it or any that was made
  /// of it: only then can an answer depend on the clock.
  [[nodiscard]] bool struck() const { return struck_->load(std::memory_order_relaxed); }

  /// Milliseconds since it was made.
  [[nodiscard]] double elapsed_ms() const;

  /// For whoever watches, if anybody does.
  void report(Progress::Stage stage) const;
  void report_collisions(std::size_t found, std::size_t corrected) const;

 private:
  using Clock = std::chrono::steady_clock;

  explicit Deadline(Clock::duration budget);

  /// Hands on what those who asked are told.
  [[nodiscard]] bool told(bool is_over) const;

  [[nodiscard]] Clock::time_point now() const;

  Clock::time_point start_;
  Clock::duration budget_;
  std::stop_token stop_;
  std::shared_ptr<Progress> progress_;
  std::shared_ptr<std::atomic<bool>> struck_ = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::atomic<std::int64_t>> looks_;  ///< at a clock that goes on by them; or null
};

}  // namespace camway::collision
