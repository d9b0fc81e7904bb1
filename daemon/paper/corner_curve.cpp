// SPDX-License-Identifier: MIT
#include "daemon/paper/corner_curve.h"

#include "daemon/motion/path/bezier.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::paper {

using geometry::Vec3;
using geometry::Vec4;
namespace bezier = motion::bezier;
namespace quaternion = motion::quaternion;

Vec3 RationalCurve::point_at(double u) const {
  const Vec4 value = bezier::value_at(homogeneous, u);
  return value.head<3>() / value[3];
}

RationalCurve corner_curve(const motion::Segment& segment, const Vec3& corner_C) {
  // R(Q)·c = Q·c·Q̄ / |Q|², quaternion products, c being pure.
  const Vec4 pure(0.0, corner_C.x(), corner_C.y(), corner_C.z());
  std::array<Vec4, 7> turned;
  std::array<Vec4, 7> conjugates;
  for (std::size_t i = 0; i < 7; ++i) {
    turned[i] = quaternion::multiply(segment.orientation[i], pure);
    conjugates[i] = quaternion::conjugate(segment.orientation[i]);
  }
  const std::array<Vec4, 13> rotated = bezier::product(turned, conjugates, quaternion::multiply);
  const std::array<double, 13> weights = motion::orientation_weights(segment);

  const std::array<Vec4, 16> rotated15 = bezier::elevated<3>(rotated);
  const std::array<double, 16> weights15 = bezier::elevated<3>(weights);
  const std::array<Vec3, 16> moved =
      bezier::product(segment.position, weights,
                      [](const Vec3& position, double weight) { return Vec3(position * weight); });
  RationalCurve curve;
  for (std::size_t i = 0; i < 16; ++i)
    curve.homogeneous[i] << moved[i] + rotated15[i].tail<3>(), weights15[i];
  return curve;
}

}  // namespace camway::paper
