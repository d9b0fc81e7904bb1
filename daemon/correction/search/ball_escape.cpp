// SPDX-License-Identifier: MIT
#include "daemon/correction/search/ball_escape.h"

namespace camway::correction {

using geometry::Vec3;
using motion::SignedPose;

std::optional<SignedPose> ball_escape(FreeSpace& space, const SignedPose& pose,
                                      double ball_radius_m) {
  const double radius_m = space.ball_radius_m();
  const Vec3 middle_W = space.center_W(motion::unsigned_pose(pose));
  // Only the sign of the gap counts, so it need not be measured farther.
  const double horizon_m = 0.1 * radius_m;
  if (space.ball_gap_m(middle_W, ball_radius_m, horizon_m) > 0.0) return pose;
  for (const double share : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
    for (int code = 0; code < 27; ++code) {
      if (code == 13) continue;  // no direction
      const Vec3 step =
          Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized() * (share * radius_m);
      if (!(space.ball_gap_m(middle_W + step, ball_radius_m, horizon_m) > 0.0)) continue;
      const SignedPose there{pose.position + step, pose.orientation};
      if (space.passes(pose, there, 0.0)) return there;
    }
  }
  return std::nullopt;
}

}  // namespace camway::correction
