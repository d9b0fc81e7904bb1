// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// Range of the viewing distances that are derived from the scene. A wall at less than the lower
/// end fills the picture. Beyond the upper end, moves change the picture little compared with
/// turns. [Units: metres]
inline constexpr double kLeastViewingDistance_m = 1.0;
inline constexpr double kMostViewingDistance_m = 10.0;

/// Returns the median distance from the path to the scene along the view direction (-Z of the
/// camera), by rays, clamped to [`kLeastViewingDistance_m`, `kMostViewingDistance_m`].
/// Approximate; no part of any proof. [Units: metres]
double viewing_distance_m(const motion::CubicPath& interpolated, const FreeSpace& space);

/// Returns the scale on which corrections of `interpolated` are compared. `viewing_distance_m`: the
/// requested distance; 0 derives it from the scene. [Limit: 0 <= viewing_distance_m]
Closeness closeness_of(const motion::CubicPath& interpolated, const FreeSpace& space,
                       double viewing_distance_m);

}  // namespace camway::correction
