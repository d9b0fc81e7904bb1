// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/derive_times.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace camway::motion {
namespace {

double turning_angle_rad(const geometry::Quat& from, const geometry::Quat& to) {
  const geometry::Quat turn = from.conjugate() * to;
  return 2.0 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

double nominal_duration_s(const Pose& from, const Pose& to, double speed_m_per_s) {
  return std::hypot(
      (to.position - from.position).norm() / speed_m_per_s,
      turning_angle_rad(from.orientation, to.orientation) / kNominalTurnRate_rad_per_s);
}

}  // namespace

std::vector<double> derive_times_s(std::span<const Pose> poses, double speed_m_per_s) {
  assert(poses.size() >= 2 && speed_m_per_s > 0.0);
  std::vector<double> durations_s;
  double sum_s = 0.0;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    durations_s.push_back(nominal_duration_s(poses[i], poses[i + 1], speed_m_per_s));
    sum_s += durations_s.back();
  }
  const double mean_s = sum_s / static_cast<double>(durations_s.size());
  const double floor_s = mean_s > 0.0 ? kShortestStep * mean_s : kStepWithoutMotion_s;
  std::vector<double> times_s = {0.0};
  for (const double duration_s : durations_s)
    times_s.push_back(times_s.back() + std::max(duration_s, floor_s));
  return times_s;
}

}  // namespace camway::motion
