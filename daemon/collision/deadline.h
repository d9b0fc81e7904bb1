// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace camway::collision {

/// The only clock that planning sees: how long it has run, and whether it must stop. A value type.
/// An answer depends on it only if it strikes.
class Deadline {
 public:
  /// Strikes `seconds` from now. [Limit: 0 <= value]
  static Deadline after_s(double seconds);

  /// Never strikes.
  static Deadline never();

  [[nodiscard]] bool passed() const;

  /// What is left, 0 once it has passed.
  [[nodiscard]] double remaining_s() const;

  /// Milliseconds since it was made.
  [[nodiscard]] double elapsed_ms() const;

 private:
  using Clock = std::chrono::steady_clock;

  explicit Deadline(Clock::duration budget);

  Clock::time_point start_;
  Clock::duration budget_;
};

}  // namespace camway::collision
