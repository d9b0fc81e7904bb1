// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"

namespace camway::motion {

/// What a path is like, for comparing paths. Extrema are over samples, dense enough for a few
/// digits: for people, not part of any proof but for the clearance.
struct PathMeasures {
  double length_m = 0.0;                  ///< of the way of the eye
  double largest_deviation_m = 0.0;       ///< of the eye from another path at the same time
  double bending_energy_m2_per_s3 = 0.0;  ///< integral of the squared acceleration; exact
  double largest_speed_m_per_s = 0.0;
  double largest_acceleration_m_per_s2 = 0.0;
  double largest_turn_rate_rad_per_s = 0.0;
  double largest_turn_acceleration_rad_per_s2 = 0.0;
  /// At least so far is the body from the scene: proved. Not for `measure` to say, which knows no
  /// scene; 0 where the path collides or nothing was proved.
  double clearance_lower_bound_m = 0.0;

  bool operator==(const PathMeasures&) const = default;
};

/// Measures of `path`; the deviation is from `original`, at equal shares of both time spans.
PathMeasures measure(const Path& path, const Path& original);

}  // namespace camway::motion
