// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"

namespace camway::bench {

/// How much a corrected path changes the shot, by samples. Largest values are over the path, each
/// from the pose of the path as interpolated at the same time.
struct Fidelity {
  double moved_m = 0.0;
  double turned_rad = 0.0;
  /// Largest shift of the picture: the angle of the turn plus atan(move / viewing distance).
  double shift_rad = 0.0;
  /// Share of the time in which the camera is moved by more than `kMoved_m` or turned by more than
  /// `kTurned_rad`.
  double changed = 0.0;
  /// 99th percentile of the eye's acceleration, as a multiple of that of the path as interpolated.
  /// NaN where that is below `kStraight_m_per_s2`: the path is straight, and the ratio means
  /// nothing.
  double acceleration = 0.0;
  double length = 0.0;  ///< length of the eye's curve, as a multiple of the original's
};

inline constexpr double kMoved_m = 1e-3;
inline constexpr double kTurned_rad = 1.7453292519943295e-3;  ///< a tenth of a degree
inline constexpr double kStraight_m_per_s2 = 1e-3;

/// Measures `path` against `original`. Requires both to cover the same time.
/// [Limit: 0 < viewing_distance_m]
Fidelity fidelity_of(const motion::Path& path, const motion::Path& original,
                     double viewing_distance_m);

}  // namespace camway::bench
