// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// Range of viewing distances that are taken from the scene. A nearer wall fills the picture, and
/// of things farther away a turn shows more than any move. [Units: metres]
inline constexpr double kLeastViewingDistance_m = 1.0;
inline constexpr double kMostViewingDistance_m = 10.0;

/// Returns the median distance from the path to the scene along the view (-Z of the camera), by
/// samples, within `kLeastViewingDistance_m` and `kMostViewingDistance_m`. Approximate; no part of
/// any proof.
double viewing_distance_m(const motion::CubicPath& interpolated, const FreeSpace& space);

/// Returns the scale for corrections of `interpolated`. `viewing_distance_m`: as requested, or 0 to
/// take it from the scene. [Limit: 0 <= viewing_distance_m]
Closeness closeness_of(const motion::CubicPath& interpolated, const FreeSpace& space,
                       double viewing_distance_m);

}  // namespace camway::correction
