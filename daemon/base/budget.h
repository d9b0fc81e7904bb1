// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

namespace camway::base {

/// The number of steps that a computation may still take. It bounds the time of a computation
/// without a clock, so that the result does not depend on one. Functions that spend steps take a
/// budget by reference. A value type.
class Budget {
 public:
  /// [Limit: 0 <= steps]
  explicit constexpr Budget(std::int64_t steps) : left_(steps) {}

  /// Steps that are left; negative if the budget is overdrawn.
  [[nodiscard]] constexpr std::int64_t left() const { return left_; }
  /// Whether that many steps are left.
  [[nodiscard]] constexpr bool covers(std::int64_t steps) const { return steps <= left_; }
  /// Whether more steps were spent than there were. A computation that learns the cost of a step
  /// afterwards stops where this is true.
  [[nodiscard]] constexpr bool is_overdrawn() const { return left_ < 0; }

  constexpr void spend(std::int64_t steps) { left_ -= steps; }

  /// Takes up to `most` of the steps out, as a budget of their own. `put_back` returns the rest.
  [[nodiscard]] constexpr Budget take(std::int64_t most) {
    const Budget part(std::clamp<std::int64_t>(left_, 0, most));
    spend(part.left());
    return part;
  }
  constexpr void put_back(const Budget& rest) { left_ += rest.left_; }

 private:
  std::int64_t left_;
};

}  // namespace camway::base
