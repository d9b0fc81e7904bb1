// SPDX-License-Identifier: MIT
#include "daemon/motion/path/measures.h"

#include <algorithm>
#include <cmath>

namespace camway::motion {

namespace {

using geometry::Vec3;

// About the number of samples of a path. Many short segments need fewer each.
constexpr double kSamplesAPath = 256.0;
// Least number of samples of a segment.
constexpr double kFewestSamples = 8.0;
// Largest number of samples of a segment.
constexpr double kMostSamples = 32.0;

// Even, for Simpson's rule.
int steps_in(const Segment& segment, double path_duration_s) {
  const double share = (segment.t1_s - segment.t0_s) / path_duration_s;
  return 2 * static_cast<int>(
                 std::ceil(0.5 * std::clamp(kSamplesAPath * share, kFewestSamples, kMostSamples)));
}

// The acceleration of a cubic changes linearly from end to end.
double bending_energy(const Segment& segment) {
  const double duration_s = segment.t1_s - segment.t0_s;
  const Vec3 begin = derivatives_at(segment, 0.0).acceleration_m_per_s2;
  const Vec3 end = derivatives_at(segment, 1.0).acceleration_m_per_s2;
  return duration_s / 3.0 * (begin.squaredNorm() + begin.dot(end) + end.squaredNorm());
}

Vec3 position(const Path& path, double time_s) {
  const Segment& segment = path.segments()[path.segment_index(time_s)];
  return position_at(segment, segment_parameter(segment, time_s));
}

void raise(double& largest, double value) { largest = std::max(largest, value); }

}  // namespace

PathMeasures measure(const Path& path, const Path& original) {
  PathMeasures measures;
  const double begin_s = path.begin_s();
  const double duration_s = path.end_s() - begin_s;
  const double original_duration_s = original.end_s() - original.begin_s();
  for (const Segment& segment : path.segments()) {
    measures.bending_energy_m2_per_s3 += bending_energy(segment);
    const int steps = steps_in(segment, duration_s);
    const double third_s = (segment.t1_s - segment.t0_s) / steps / 3.0;
    for (int i = 0; i <= steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      const SegmentDerivatives at = derivatives_at(segment, u);
      const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      measures.length_m += weight * third_s * at.velocity_m_per_s.norm();
      // A path as it was made is its own original.
      if (&path != &original) {
        const double share = (segment_time_s(segment, u) - begin_s) / duration_s;
        const Vec3 before = position(original, original.begin_s() + share * original_duration_s);
        raise(measures.largest_deviation_m, (position_at(segment, u) - before).norm());
      }
      raise(measures.largest_speed_m_per_s, at.velocity_m_per_s.norm());
      raise(measures.largest_acceleration_m_per_s2, at.acceleration_m_per_s2.norm());
      // A quaternion moves on the sphere at half the rate of the rotation. The tangential part of
      // its second derivative belongs to the change of that rate.
      raise(measures.largest_turn_rate_rad_per_s, 2.0 * at.orientation_rate_per_s.norm());
      const double squared = at.orientation_acceleration_per_s2.squaredNorm();
      const double inward = at.orientation_rate_per_s.squaredNorm();
      raise(measures.largest_turn_acceleration_rad_per_s2,
            2.0 * std::sqrt(std::max(0.0, squared - inward * inward)));
    }
  }
  return measures;
}

}  // namespace camway::motion
