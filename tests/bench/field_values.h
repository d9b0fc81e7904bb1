// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "tests/bench/measure.h"

/// Statistics of one member over several items. A value that is not known is NaN, and does not
/// count; without any known value the result is NaN.
namespace camway::bench {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Returns the values of a member that are numbers: a path that was not found has no length.
template <class Item>
std::vector<double> numbers(const std::vector<const Item*>& items, double Item::*field) {
  std::vector<double> values;
  for (const Item* item : items) {
    if (std::isfinite(item->*field)) values.push_back(item->*field);
  }
  return values;
}

/// Returns the value below which the fraction `share` of the values lies. [Limit: 0 <= share <= 1]
template <class Item>
double quantile_of(const std::vector<const Item*>& items, double Item::*field, double share) {
  const std::vector<double> values = numbers(items, field);
  return values.empty() ? kUnknown : quantile(values, share);
}

template <class Item>
double mean_of(const std::vector<const Item*>& items, double Item::*field) {
  const std::vector<double> values = numbers(items, field);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kUnknown : sum / static_cast<double>(values.size());
}

}  // namespace camway::bench
