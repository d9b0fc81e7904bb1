// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>

namespace camway::view {

/// Limits how often something may happen: so often in a second, and so often at once after a pause.
/// Thread-safe.
class ChangeRate {
 public:
  ChangeRate(double per_s, double burst) : per_s_(per_s), burst_(burst), left_(burst) {}

  /// Counts one more. Returns false, and counts nothing, if that is too often.
  bool take() {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> passed = now - before_;
    left_ = std::min(burst_, left_ + passed.count() * per_s_);
    before_ = now;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;

  const double per_s_;
  const double burst_;
  std::mutex mutex_;
  double left_;
  Clock::time_point before_ = Clock::now();
};

}  // namespace camway::view
