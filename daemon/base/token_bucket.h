// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>

namespace camway::base {

/// Limits a rate: permits a burst at once, then a number of events per second.
/// Not thread-safe.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;

  /// The bucket begins full. [Limit: 0 < per_s, 1 <= burst]
  TokenBucket(double per_s, double burst) : per_s_(per_s), burst_(burst), tokens_(burst) {}

  /// Returns whether an event is permitted now, and counts it if so.
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

}  // namespace camway::base
