// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace camway::wire {

/// Returns the present time for `utime` members: microseconds since 1970.
inline std::int64_t utime_now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
}

}  // namespace camway::wire
