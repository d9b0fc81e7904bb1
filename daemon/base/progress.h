// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace camway::base {

/// Progress of planning, which planning writes and any thread may read at any time. Members are
/// written one by one, so a reader may see old and new values together.
/// Thread-safe.
struct Progress {
  enum class Stage { kWaiting, kPreparing, kDetecting, kCorrecting, kCertifying };

  std::atomic<Stage> stage = Stage::kWaiting;
  std::atomic<int> collisions = 0;  ///< collisions found on the interpolated path
  std::atomic<int> corrected = 0;   ///< number of them that are corrected
};

}  // namespace camway::base
