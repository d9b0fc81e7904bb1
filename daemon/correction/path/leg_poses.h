// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// Returns the poses of the interpolated path at equal steps in time, from the keyframe before the
/// collision to the one after it. [Limit: 0 < steps]
std::vector<motion::Pose> poses_as_interpolated(const Problem& problem, int steps);

/// Returns about the largest turn of `path` from the interpolated path between these keyframes, at
/// equal steps in time. [Limit: 0 < steps]
double largest_turn_rad(const Problem& problem, const motion::CubicPath& path, int steps);

/// Returns a guide for the body along `way_W`, a way of its centre from `begin` to `end`, from
/// keyframe to keyframe. It has the orientations of the problem's path, at equal shares of the way
/// and of the time. [Limit: `way_W` has two points or more]
Guide oriented(const Problem& problem, const FreeSpace& space,
               std::span<const geometry::Vec3> way_W, const motion::SignedPose& begin,
               const motion::SignedPose& end);

}  // namespace camway::correction
