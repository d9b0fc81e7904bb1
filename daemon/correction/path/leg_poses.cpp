// SPDX-License-Identifier: MIT
#include "daemon/correction/path/leg_poses.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "daemon/correction/path/polyline.h"

namespace camway::correction {

namespace {

double time_at_s(const Problem& problem, double share) {
  return std::lerp(problem.leg_begin_s(), problem.leg_end_s(), share);
}

}  // namespace

std::vector<motion::Pose> poses_as_interpolated(const Problem& problem, int steps) {
  std::vector<motion::Pose> poses;
  for (int i = 0; i <= steps; ++i) {
    poses.push_back(problem.original.pose(time_at_s(problem, static_cast<double>(i) / steps)));
  }
  return poses;
}

double largest_turn_rad(const Problem& problem, const motion::CubicPath& path, int steps) {
  double largest_rad = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double time_s = time_at_s(problem, static_cast<double>(i) / steps);
    const geometry::Quat before = problem.original.pose(time_s).orientation;
    largest_rad = std::max(largest_rad, path.pose(time_s).orientation.angularDistance(before));
  }
  return largest_rad;
}

Guide oriented(const Problem& problem, const FreeSpace& space,
               std::span<const geometry::Vec3> way_W, const motion::SignedPose& begin,
               const motion::SignedPose& end) {
  const double whole_m = length_m(way_W);
  Guide guide = {signed_pose_at(problem.path, problem.leg_begin_s())};
  double so_far_m = 0.0;
  for (std::size_t i = 0; i < way_W.size(); ++i) {
    if (i > 0) so_far_m += (way_W[i] - way_W[i - 1]).norm();
    const double share = whole_m > 0.0 ? so_far_m / whole_m : 0.0;
    const double time_s = time_at_s(problem, std::clamp(share, 0.0, 1.0));
    const geometry::Vec4 q = signed_pose_at(problem.path, time_s).orientation;
    guide.push_back({space.pose_around(way_W[i], geometry::from_wxyz(q)).position, q});
  }
  guide[1] = begin;
  guide.back() = end;
  guide.push_back(signed_pose_at(problem.path, problem.leg_end_s()));
  return guide;
}

}  // namespace camway::correction
