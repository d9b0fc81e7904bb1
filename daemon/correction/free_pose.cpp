// SPDX-License-Identifier: MIT
#include "daemon/correction/free_pose.h"

#include <algorithm>

namespace camway::correction {

namespace {

constexpr double kFirstStep = 0.02;  // radii
constexpr double kGrowth = 1.4;

}  // namespace

std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m) {
  const double radius_m = space.ball_radius_m();
  const auto moved = [&](const geometry::Vec3& direction_W, double by_m) {
    return motion::Pose{pose.position + by_m * direction_W, pose.orientation};
  };
  std::optional<FreePose> best;
  for (int code = 0; code < 27; ++code) {
    if (code == 13) continue;
    const geometry::Vec3 direction_W =
        geometry::Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized();
    const auto is_free = [&](double by_m) {
      return space.is_free(moved(direction_W, by_m), margin_m);
    };
    const double limit_m = best ? best->moved_m : kFreePoseReach * radius_m;
    double below_m = 0.0;
    double above_m = std::min(kFirstStep * radius_m, limit_m);
    while (above_m < limit_m && !is_free(above_m)) {
      below_m = above_m;
      above_m = std::min(kGrowth * above_m, limit_m);
    }
    if (above_m >= limit_m && !is_free(limit_m)) continue;
    while (above_m - below_m > kFreePosePrecision * above_m) {
      const double middle_m = 0.5 * (below_m + above_m);
      (is_free(middle_m) ? above_m : below_m) = middle_m;
    }
    if (above_m < limit_m || !best) best = FreePose{moved(direction_W, above_m), above_m};
  }
  return best;
}

}  // namespace camway::correction
