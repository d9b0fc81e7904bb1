// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/collision/interval.h"
#include "daemon/correction/path/closeness.h"

namespace camway::correction {

/// Kind of a correction, cheapest first.
enum class CorrectionKind : std::uint8_t {
  kNone,     ///< not corrected
  kMove,     ///< the camera was moved sideways
  kTurn,     ///< the camera was turned
  kGoRound,  ///< the camera takes a detour
  kShrink,   ///< the near distance was reduced
};

/// Effort spent on a correction; a counter is 0 if its method was not tried.
struct Effort {
  std::int32_t directions = 0;  ///< directions and axes in which a nudge was tried
  std::int32_t paths = 0;       ///< changed paths that were checked for collisions
  /// Lattice points and cells that searches for a detour visited.
  std::int32_t lattice_points = 0;
  std::int32_t tree_samples = 0;  ///< random samples that searches for a turning detour drew

  /// Counts stop at their largest value.
  Effort& operator+=(const Effort& other);
  bool operator==(const Effort&) const = default;
};

/// Outcome for one collision of the interpolated path.
struct Correction {
  collision::CollisionInterval interval;  ///< the collision
  CorrectionKind kind = CorrectionKind::kNone;
  double t_begin_s = 0.0;  ///< begin of the part of the path that was changed
  double t_end_s = 0.0;    ///< end of that part
  double moved_m = 0.0;    ///< largest distance of the eye from the interpolated path, time by time
  double turned_rad = 0.0;  ///< largest angle from the interpolated orientation, time by time
  Shift shift = {};         ///< from the interpolated path, on the changed part
  Effort tried = {};        ///< effort spent, if the collision was not corrected
};

}  // namespace camway::correction
