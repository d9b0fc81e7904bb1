// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/fidelity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "daemon/motion/path/measures.h"

namespace camway::bench {

namespace {

constexpr int kPoses = 2000;
constexpr int kAccelerations = 600;
constexpr double kPercentile = 0.99;

double percentile_of_acceleration_m_per_s2(const motion::Path& path) {
  std::vector<double> values;
  for (int i = 0; i < kAccelerations; ++i) {
    const double share = (i + 0.5) / kAccelerations;
    const double time_s = std::lerp(path.begin_s(), path.end_s(), share);
    const motion::Segment& segment = path.segments()[path.segment_index(time_s)];
    const double u = motion::segment_parameter(segment, time_s);
    values.push_back(motion::derivatives_at(segment, u).acceleration_m_per_s2.norm());
  }
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(kPercentile * (kAccelerations - 1))];
}

}  // namespace

Fidelity fidelity_of(const motion::Path& path, const motion::Path& original,
                     double viewing_distance_m) {
  Fidelity result;
  int changed = 0;
  for (int i = 0; i <= kPoses; ++i) {
    const double share = static_cast<double>(i) / kPoses;
    const double time_s = std::lerp(original.begin_s(), original.end_s(), share);
    const motion::Pose now = path.pose(time_s);
    const motion::Pose before = original.pose(time_s);
    const double moved_m = (now.position - before.position).norm();
    const double turn_rad = now.orientation.angularDistance(before.orientation);
    result.moved_m = std::max(result.moved_m, moved_m);
    result.turned_rad = std::max(result.turned_rad, turn_rad);
    const double shift_rad = turn_rad + std::atan(moved_m / viewing_distance_m);
    result.shift_rad = std::max(result.shift_rad, shift_rad);
    if (moved_m > kMoved_m || turn_rad > kTurned_rad) ++changed;
  }
  result.changed = static_cast<double>(changed) / (kPoses + 1);
  const double before_m_per_s2 = percentile_of_acceleration_m_per_s2(original);
  result.acceleration = before_m_per_s2 > kStraight_m_per_s2
                            ? percentile_of_acceleration_m_per_s2(path) / before_m_per_s2
                            : std::numeric_limits<double>::quiet_NaN();
  result.length =
      motion::measure(path, original).length_m / motion::measure(original, original).length_m;
  return result;
}

}  // namespace camway::bench
