// SPDX-License-Identifier: MIT
#include "daemon/correction/path/viewing_distance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace camway::correction {

namespace {

using geometry::Vec3;

constexpr int kRays = 9;

double distance_along_view_m(const motion::Pose& pose, const FreeSpace& space) {
  const Vec3 view_W = pose.orientation * -Vec3::UnitZ();
  const std::optional<scene::SegmentHit> hit = space.obstacles().index.closest_hit(
      {pose.position, pose.position + kMostViewingDistance_m * view_W});
  return hit ? std::max(kLeastViewingDistance_m, hit->fraction * kMostViewingDistance_m)
             : kMostViewingDistance_m;
}

}  // namespace

double viewing_distance_m(const motion::CubicPath& interpolated, const FreeSpace& space) {
  std::vector<double> distances_m;
  for (int i = 0; i < kRays; ++i) {
    const double share = (i + 0.5) / kRays;
    const double time_s = std::lerp(interpolated.begin_s(), interpolated.end_s(), share);
    distances_m.push_back(distance_along_view_m(interpolated.pose(time_s), space));
  }
  std::ranges::sort(distances_m);
  return distances_m[kRays / 2];
}

Closeness closeness_of(const motion::CubicPath& interpolated, const FreeSpace& space,
                       double viewing_distance_m) {
  Closeness closeness;
  closeness.viewing_distance_m = viewing_distance_m > 0.0
                                     ? viewing_distance_m
                                     : correction::viewing_distance_m(interpolated, space);
  const bool is_camera = space.body().is_camera();
  closeness.turn_lever_m = is_camera ? closeness.viewing_distance_m : space.ball_radius_m();
  if (!is_camera) closeness.center_C = space.center_C();
  closeness.acceleration_m_per_s2 =
      reference_acceleration_m_per_s2(interpolated, closeness.viewing_distance_m);
  return closeness;
}

}  // namespace camway::correction
