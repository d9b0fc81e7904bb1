// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "daemon/base/named_enum.h"
#include "daemon/collision/interval.h"

namespace camway::correction {

/// How a collision was corrected: the rungs of the ladder (design, section 7).
enum class Rung : std::uint8_t {
  kNone,     ///< it was not
  kMove,     ///< the camera was moved to one side
  kTurn,     ///< it was turned
  kGoRound,  ///< it goes another way
  kShrink,   ///< its near distance was made smaller
};

constexpr std::array<std::string_view, 5> names_of(Rung) {
  return {"none", "move", "turn", "go_round", "shrink"};
}
/// "none", "move", "turn", "go_round", "shrink".
inline std::string_view to_string(Rung rung) { return base::name_of(rung); }

/// How hard a correction was looked for. 0 where that was not tried at all.
struct Effort {
  std::int32_t directions = 0;  ///< to one side or about an axis, to move or turn the camera
  std::int32_t paths = 0;       ///< changed paths that were checked for collisions
  /// Of lattices and cells, at which there might have been room on a way round.
  std::int32_t lattice_points = 0;
  std::int32_t tree_samples = 0;  ///< poses towards which ways round were looked for that turn

  Effort& operator+=(const Effort& other);
  bool operator==(const Effort&) const = default;
};

/// What became of one collision of the path as interpolated.
struct Correction {
  collision::CollisionInterval interval;  ///< as it was found
  Rung rung = Rung::kNone;
  double t_begin_s = 0.0;  ///< what of the path was changed for it
  double t_end_s = 0.0;
  double moved_m = 0.0;     ///< furthest that the eye is from where it was at the same time
  double turned_rad = 0.0;  ///< most that the camera is turned from how it was
  Effort tried = {};        ///< where it was not corrected
};

}  // namespace camway::correction
