// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>

namespace camway::c {

/// Returns the end of a wait of `timeout_s`, above 0, which may be infinite.
inline std::chrono::steady_clock::time_point end_of_wait(double timeout_s) {
  // Longest wait that the clock can add to now: a year.
  constexpr double kLongest_s = 365.0 * 86'400.0;
  const std::chrono::duration<double> timeout(std::min(timeout_s, kLongest_s));
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(timeout);
}

}  // namespace camway::c
