// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"
#include "tools/camway/replay/compare/difference.h"

namespace camway::tools {

/// `Difference::path_m` and `Difference::shift_rad` of two paths.
struct PathDistance {
  double path_m = 0.0;
  double shift_rad = 0.0;
};

/// Returns the distance of paths that differ in a bit at least, which is never 0.
PathDistance path_distance(const motion::Path& a, const motion::Path& b,
                           const Yardstick& yardstick);

}  // namespace camway::tools
