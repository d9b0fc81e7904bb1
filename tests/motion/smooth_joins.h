// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"
#include "tests/motion/random_motion.h"

namespace camway::motion::test {

template <class Points>
double longest(const Points& points) {
  double length = 0.0;
  for (const auto& point : points) length = std::max(length, point.norm());
  return length;
}

// Expects a C² join. The derivatives of a segment are differences of its control points, times 3
// and 6 (position) or 6 and 30 (orientation), divided by powers of its duration. Storing a control
// point rounds it by half an epsilon of its size; the sums and products that make it round a few
// times more, and normalisation multiplies by the ratio of lengths. `roundings` scales the allowed
// error.
inline void expect_smooth_join(const Segment& before, const Segment& after,
                               double roundings = 1.0) {
  EXPECT_EQ(before.t1_s, after.t0_s);
  EXPECT_EQ(before.position[3], after.position[0]);
  EXPECT_EQ(before.orientation[6], after.orientation[0]);
  const SegmentDerivatives left = derivatives_at(before, 1.0);
  const SegmentDerivatives right = derivatives_at(after, 0.0);
  const double step_s = std::min(before.t1_s - before.t0_s, after.t1_s - after.t0_s);
  const double size_m = std::max(longest(before.position), longest(after.position));
  const double ratio = std::max(longest(before.orientation), longest(after.orientation)) /
                       after.orientation[0].norm();
  const double position_m = roundings * 8.0 * kEpsilon * size_m;
  const double orientation = roundings * 32.0 * kEpsilon * ratio * ratio;
  EXPECT_LE((left.velocity_m_per_s - right.velocity_m_per_s).norm(), position_m / step_s);
  EXPECT_LE((left.acceleration_m_per_s2 - right.acceleration_m_per_s2).norm(),
            4.0 * position_m / (step_s * step_s));
  EXPECT_LE((left.orientation_rate_per_s - right.orientation_rate_per_s).norm(),
            orientation / step_s);
  EXPECT_LE((left.orientation_acceleration_per_s2 - right.orientation_acceleration_per_s2).norm(),
            8.0 * orientation / (step_s * step_s));
}

inline void expect_smooth(const Path& path, double roundings = 1.0) {
  for (std::size_t i = 0; i + 1 < path.segments().size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "join " << i);
    expect_smooth_join(path.segments()[i], path.segments()[i + 1], roundings);
  }
}

}  // namespace camway::motion::test
