// SPDX-License-Identifier: MIT
#include "daemon/motion/path/straight_motion.h"

#include "daemon/motion/path/bezier.h"

namespace camway::motion {

namespace {

template <class Points, class Point>
void spread(Points& points, const Point& from, const Point& to) {
  const auto last = static_cast<double>(points.size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = bezier::lerp(from, to, static_cast<double>(i) / last);
  }
}

}  // namespace

Segment straight_motion(const SignedPose& from, const SignedPose& to) {
  Segment segment;
  segment.t0_s = 0.0;
  segment.t1_s = 1.0;
  spread(segment.position, from.position, to.position);
  spread(segment.orientation, from.orientation, to.orientation);
  return segment;
}

SignedPose between(const SignedPose& from, const SignedPose& to, double u) {
  return {bezier::lerp(from.position, to.position, u),
          bezier::lerp(from.orientation, to.orientation, u).normalized()};
}

SignedPose signed_like(const Pose& pose, const SignedPose& other) {
  SignedPose result = signed_pose(pose);
  if (result.orientation.dot(other.orientation) < 0.0) result.orientation *= -1.0;
  return result;
}

}  // namespace camway::motion
