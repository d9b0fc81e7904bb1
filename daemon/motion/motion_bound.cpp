// SPDX-License-Identifier: MIT
#include "daemon/motion/motion_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;

// A chain of fewer than eight operations, each of which rounds by half of this at most.
constexpr double kRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

double translation_bound_m(const Segment& part, double size_m) {
  const Vec3 middle = position_at(part, 0.5);
  double distance_m = 0.0;
  for (const Vec3& point : part.position)
    distance_m = std::max(distance_m, (point - middle).norm());
  return distance_m * kRoundUp + size_m * kTranslationRounding;
}

double turn_bound_rad(const Segment& part, double size) {
  constexpr double kNothingKnown = std::numbers::pi;
  const Vec4 numerator = orientation_numerator_at(part, 0.5);
  const double length = numerator.norm();
  if (!(length > 0.0)) return kNothingKnown;
  const Vec4 middle = numerator / length;
  double cone_rad = 0.0;
  double shortest = length;
  for (const Vec4& point : part.orientation) {
    const double along = middle.dot(point);
    if (!(along > 0.0)) return kNothingKnown;
    // From the perpendicular part: an arc cosine has lost half the digits for a small angle.
    cone_rad = std::max(cone_rad, std::atan2((point - along * middle).norm(), along));
    shortest = std::min(shortest, along);
  }
  const double bound_rad = 2.0 * (cone_rad * kRoundUp + kConeAngleRounding * (size / shortest));
  return std::min(bound_rad, kNothingKnown);
}

template <class Points>
double longest(const Points& points) {
  double length = 0.0;
  for (const auto& point : points) length = std::max(length, point.norm());
  return length;
}

MotionBound bound_part(const Segment& part, const Segment& whole) {
  return {translation_bound_m(part, longest(whole.position)),
          turn_bound_rad(part, longest(whole.orientation))};
}

}  // namespace

MotionBound motion_bound(const Segment& segment) { return bound_part(segment, segment); }

MotionBound motion_bound(const Segment& segment, double u0, double u1) {
  return bound_part(sub_segment(segment, u0, u1), segment);
}

double deviation_m(const MotionBound& bound, double body_radius_m) {
  const double half_turn_rad = std::min(bound.turn_rad, std::numbers::pi) / 2.0;
  return (bound.translation_m + 2.0 * body_radius_m * std::sin(half_turn_rad)) * kRoundUp;
}

}  // namespace camway::motion
