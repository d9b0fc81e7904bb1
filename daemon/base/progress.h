// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace camway::collision {

/// How far planning is, for whoever waits for it. Planning writes it, any thread may read it at any
/// time; the members are not in step with each other.
struct Progress {
  enum class Stage { kWaiting, kPreparing, kDetecting, kCorrecting, kCertifying };

  std::atomic<Stage> stage = Stage::kWaiting;
  std::atomic<int> collisions = 0;  ///< found on the path as interpolated
  std::atomic<int> corrected = 0;   ///< of them
};

}  // namespace camway::collision
