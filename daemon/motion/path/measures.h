// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"

namespace camway::motion {

/// Properties of a path, for comparison. Extrema are taken over samples, dense enough for a few
/// digits; except for the clearance they are no part of any proof.
struct PathMeasures {
  double length_m = 0.0;                  ///< length of the eye's curve
  double largest_deviation_m = 0.0;       ///< largest distance of the eye from the other path
  /// Largest and mean shift of the picture (`correction/path/closeness.h`). Set by planning, not by
  /// `measure`.
  double largest_shift_rad = 0.0;
  double mean_shift_rad = 0.0;
  double bending_energy_m2_per_s3 = 0.0;  ///< integral of the squared acceleration; exact
  double largest_speed_m_per_s = 0.0;
  double largest_acceleration_m_per_s2 = 0.0;
  double largest_turn_rate_rad_per_s = 0.0;
  double largest_turn_acceleration_rad_per_s2 = 0.0;
  /// Proved lower bound of the distance between the body and the scene. Set by planning, not by
  /// `measure`; 0 where the path collides or nothing was proved.
  double clearance_lower_bound_m = 0.0;

  bool operator==(const PathMeasures&) const = default;
};

/// Measures `path`; the deviation is from `original`, at equal shares of both time spans.
PathMeasures measure(const Path& path, const Path& original);

}  // namespace camway::motion
