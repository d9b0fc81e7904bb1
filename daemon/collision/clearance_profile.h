// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/collision/query.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// A time range of a path, with a lower bound of the distance between body and scene at every
/// instant of it, rounding included.
struct ClearanceStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double clearance_m = 0.0;

  bool operator==(const ClearanceStretch&) const = default;
};

/// Largest number of stretches of a profile: a curve on a screen needs no more.
inline constexpr std::size_t kMostProfileStretches = 256;

/// Proves the clearance along a path. The stretches cover the whole path without gaps, in order of
/// time. A stretch of a proof ends where its bound is at least about 0.7 of the distance at its
/// middle, or where its motion is at most a millimetre; neighbours with similar bounds are joined.
///
/// `colliding` are the collisions of the path, in order; they have the bound 0. `least_m` is a
/// proved lower bound for the whole path. No stretch without a collision is below it, and the
/// smallest bound is exactly this one unless there are collisions. Bounds of the scene
/// (`Obstacles::bounds`) are not considered. Bounds are at most `kLargestClearance_m`, or `least_m`
/// if that is larger.
///
/// Where the deadline strikes, the rest of the path has the bound `least_m`. Thread-safe.
std::vector<ClearanceStretch> clearance_profile(const Query& query, const motion::Path& path,
                                                std::span<const CollisionInterval> colliding,
                                                double least_m, const base::Deadline& deadline);

/// Maps times that are rounded.
struct TimeMap {
  using Map = std::function<double(double)>;
  Map nearest;     ///< for the ends of the path
  Map not_after;   ///< never later than the exact time
  Map not_before;  ///< never earlier than the exact time
};

/// Maps the times of a profile. Where two stretches meet, the one with the smaller bound gets the
/// rounding, so that the bounds still hold. Stretches that vanish are left out.
void move_times(const TimeMap& map, std::vector<ClearanceStretch>& profile);

/// Joins neighbours until there are at most `most`, small bounds last. Each joined stretch has the
/// smallest bound of its parts. [Limit: 1 <= most]
void join_neighbours(std::size_t most, std::vector<ClearanceStretch>& profile);

}  // namespace camway::collision
