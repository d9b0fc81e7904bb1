// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>

namespace camway::base {

/// Returns the largest value of `of(x)` between the first and the last of `places`, which increase
/// strictly. It is found by golden sections between the neighbours of the place with the largest
/// value (Kiefer 1953, "Sequential minimax search for a maximum"), and right where the function has
/// one peak there. Requires a place.
template <class Function>
double largest_value(std::span<const double> places, const Function& of) {
  constexpr int kSections = 14;  // of two steps, to a thousandth of a step
  std::size_t best_place = 0;
  double best = of(places[0]);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double value = of(places[i]);
    if (value > best) {
      best = value;
      best_place = i;
    }
  }
  double low = places[best_place > 0 ? best_place - 1 : 0];
  double high = places[std::min(best_place + 1, places.size() - 1)];
  for (int i = 0; i < kSections; ++i) {
    const double left = high - (std::numbers::phi - 1.0) * (high - low);
    const double right = low + (std::numbers::phi - 1.0) * (high - low);
    const double at_left = of(left);
    const double at_right = of(right);
    best = std::max({best, at_left, at_right});
    (at_left < at_right ? low : high) = at_left < at_right ? left : right;
  }
  return best;
}

}  // namespace camway::base
