// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>

namespace camway::service {

/// Lets something happen so many times at once, then so many times a second. For one thread at a
/// time.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;

  /// It is full at first. [Limit: 0 < per_s, 1 <= burst]
  TokenBucket(double per_s, double burst) : per_s_(per_s), burst_(burst), tokens_(burst) {}

  /// Whether it may happen now; then it counts as having happened.
  bool take(Clock::time_point now) {
    const std::chrono::duration<double> passed = now - filled_;
    if (passed.count() > 0.0) {
      tokens_ = std::min(burst_, tokens_ + passed.count() * per_s_);
      filled_ = now;
    }
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

 private:
  double per_s_;
  double burst_;
  double tokens_;
  Clock::time_point filled_{};  ///< when the tokens were last counted
};

}  // namespace camway::service
