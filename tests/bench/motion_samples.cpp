// SPDX-License-Identifier: MIT
#include "tests/bench/motion_samples.h"

#include <algorithm>
namespace camway::bench {

namespace {

double farthest_corner_m(const motion::Corners& a, const motion::Corners& b) {
  double most_m = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most_m = std::max(most_m, (a[i] - b[i]).norm());
  return most_m;
}

}  // namespace

std::vector<MotionSample> motion_samples(const motion::Path& path, const motion::Camera& camera,
                                         double step_m) {
  const motion::Corners corners_C = motion::near_corners_C(camera);
  constexpr double kFirstTry = 1.0 / 1024.0;
  std::vector<MotionSample> samples;
  for (std::size_t s = 0; s < path.segments().size(); ++s) {
    const motion::Segment& segment = path.segments()[s];
    const auto corners_at = [&](double u) {
      return motion::corners_W(corners_C, motion::pose_at(segment, u));
    };
    double u = 0.0;
    double du = kFirstTry;
    motion::Corners here = corners_at(u);
    samples.push_back({s, u, segment.t0_s});
    while (u < 1.0) {
      double next = std::min(1.0, u + du);
      double moved_m = farthest_corner_m(here, corners_at(next));
      while (moved_m > step_m && next > u) {
        next = u + (next - u) * std::min(0.98, step_m / moved_m);
        moved_m = farthest_corner_m(here, corners_at(next));
      }
      du = (next - u) * (moved_m > 0.0 ? std::min(2.0, 0.995 * step_m / moved_m) : 2.0);
      u = next;
      here = corners_at(u);
      samples.push_back({s, u, motion::segment_time_s(segment, u)});
    }
  }
  return samples;
}

bool SampledIntervals::sees(double from_s, double to_s) const {
  for (std::size_t i = 0; i < begin_s.size(); ++i) {
    if (begin_s[i] <= to_s && end_s[i] >= from_s) return true;
  }
  return false;
}

}  // namespace camway::bench
