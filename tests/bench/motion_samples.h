// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"

namespace camway::bench {

/// A sample of a path.
struct MotionSample {
  std::size_t segment = 0;
  double u = 0.0;
  double time_s = 0.0;
};

/// Returns samples between which no corner of the near quadrilateral moves by more than `step_m`,
/// and nearly as few as possible. Contenders that check samples need them; the time to compute them
/// is not counted.
std::vector<MotionSample> motion_samples(const motion::Path& path, const motion::Camera& camera,
                                         double step_m);

/// The collision intervals that a check of samples finds.
struct SampledIntervals {
  std::vector<double> begin_s;
  std::vector<double> end_s;
  std::size_t samples = 0;
  std::size_t colliding = 0;

  /// Returns whether an interval of colliding samples meets [from_s, to_s].
  [[nodiscard]] bool sees(double from_s, double to_s) const;
};

/// Checks every sample, and joins consecutive colliding ones to intervals.
template <class Collides>
SampledIntervals check_samples(const motion::Path& path, const std::vector<MotionSample>& samples,
                               const Collides& collides) {
  SampledIntervals seen;
  seen.samples = samples.size();
  bool before = false;
  for (const MotionSample& sample : samples) {
    const bool now = collides(motion::pose_at(path.segments()[sample.segment], sample.u));
    if (now && !before) seen.begin_s.push_back(sample.time_s);
    if (now && !before) seen.end_s.push_back(sample.time_s);
    if (now) seen.end_s.back() = sample.time_s;
    seen.colliding += now ? 1 : 0;
    before = now;
  }
  return seen;
}

}  // namespace camway::bench
