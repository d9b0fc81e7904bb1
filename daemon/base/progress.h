// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace camway::collision {

/// Progress of planning. Planning writes it; any thread may read it at any time. The members are
/// not updated together.
struct Progress {
  enum class Stage { kWaiting, kPreparing, kDetecting, kCorrecting, kCertifying };

  std::atomic<Stage> stage = Stage::kWaiting;
  std::atomic<int> collisions = 0;  ///< collisions found on the interpolated path
  std::atomic<int> corrected = 0;   ///< those of them that are corrected
};

}  // namespace camway::collision
