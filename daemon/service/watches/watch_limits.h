// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>

namespace camway::service {

/// Limits on the paths that clients may have watched.
struct WatchLimits {
  std::size_t paths = 16384;                         ///< paths of all clients [Limit: 0 <= value]
  std::size_t paths_of_a_client = 16384;             ///< paths of one client [Limit: 0 <= value]
  std::size_t bytes = std::size_t{512} << 20;        ///< size of paths and requests together
  std::chrono::milliseconds longest_lease{300'000};  ///< longest lease without a renewal
};

}  // namespace camway::service
