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

/// Samples such that no corner of the near quadrilateral is further than `step_m` from where it was
/// at the sample before, and about as few as that allows. Whoever checks collisions at samples
/// needs them; working them out is not counted against him.
std::vector<MotionSample> motion_samples(const motion::Path& path, const motion::Camera& camera,
                                         double step_m);

/// What a sampled check sees.
struct SampledIntervals {
  std::vector<double> begin_s;
  std::vector<double> end_s;
  std::size_t samples = 0;
  std::size_t colliding = 0;

  /// Whether any colliding sample lies in [begin, end].
  [[nodiscard]] bool sees(double from_s, double to_s) const;
};

/// Checks every sample, as all intervals are wanted, and joins those in a row.
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
