// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// Returns paths that pass what collides on other sides than `path`, without regard to how planning
/// finds them: in one changed range of `path` at a time, its offset from the path as interpolated
/// is rotated about the direction of travel, by each of `kSides` angles, and enlarged up to
/// `kMostEnlarged` times until the path is proved free. The paths are C² and meet the keyframes, as
/// an offset that is zero stays zero. Only paths that are proved free.
std::vector<motion::CubicPath> other_sides(const Shot& shot, const motion::CubicPath& path);

inline constexpr int kSides = 8;  ///< the first of which is that of `path`
inline constexpr double kMostEnlarged = 4.0;

}  // namespace camway::bench
