// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>

namespace camway::service {

/// What clients may leave with the daemon to be watched.
struct WatchLimits {
  std::size_t paths = 16384;                         ///< of all clients [Limit: 0 <= value]
  std::size_t paths_of_a_client = 16384;             ///< likewise
  std::size_t bytes = std::size_t{512} << 20;        ///< of paths and requests together
  std::chrono::milliseconds longest_lease{300'000};  ///< without a word from the client
};

}  // namespace camway::service
