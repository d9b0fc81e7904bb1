// SPDX-License-Identifier: MIT
#include "daemon/motion/path/segment.h"

#include <algorithm>
#include <cassert>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {

using geometry::Vec3;
using geometry::Vec4;

double segment_parameter(const Segment& segment, double time_s) {
  return std::clamp((time_s - segment.t0_s) / (segment.t1_s - segment.t0_s), 0.0, 1.0);
}

double segment_time_s(const Segment& segment, double u) {
  return bezier::lerp(segment.t0_s, segment.t1_s, u);
}

Vec3 position_at(const Segment& segment, double u) { return bezier::value_at(segment.position, u); }

Vec4 orientation_numerator_at(const Segment& segment, double u) {
  return bezier::value_at(segment.orientation, u);
}

Pose pose_at(const Segment& segment, double u) {
  const Vec4 q = orientation_numerator_at(segment, u);
  return {position_at(segment, u), geometry::from_wxyz(q / q.norm())};
}

SegmentDerivatives derivatives_at(const Segment& segment, double u) {
  const double duration_s = segment.t1_s - segment.t0_s;
  const bezier::Jet<Vec3> p = bezier::jet_at(segment.position, u);
  const bezier::Jet<Vec4> n = bezier::jet_at(segment.orientation, u);
  // With N = |N| q, the product rule gives q' and then q''.
  const double length = n.value.norm();
  const Vec4 q = n.value / length;
  const double length_first = q.dot(n.first);
  const Vec4 q_first = (n.first - length_first * q) / length;
  const double length_second = q.dot(n.second) + q_first.dot(n.first);
  const Vec4 q_second = (n.second - length_second * q - 2.0 * length_first * q_first) / length;
  return {p.first / duration_s, p.second / duration_s / duration_s, q_first / duration_s,
          q_second / duration_s / duration_s};
}

Segment sub_segment(const Segment& segment, double u0, double u1) {
  assert(0.0 <= u0 && u0 < u1 && u1 <= 1.0);
  return {segment_time_s(segment, u0), segment_time_s(segment, u1),
          bezier::sub_curve(segment.position, u0, u1),
          bezier::sub_curve(segment.orientation, u0, u1)};
}

std::array<double, 13> orientation_weights(const Segment& segment) {
  return bezier::product(segment.orientation, segment.orientation,
                         [](const Vec4& a, const Vec4& b) { return a.dot(b); });
}

double smallest_orientation_weight(const Segment& segment) {
  return std::ranges::min(orientation_weights(segment));
}

}  // namespace camway::motion
