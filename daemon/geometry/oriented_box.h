// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// A box around triangles, along their own directions: it fits a quadrilateral, or a box that is
/// turned, without any slack. For cheap proofs that a triangle is far away. A value; const calls
/// are safe from any thread.
class OrientedBox {
 public:
  OrientedBox() = default;
  /// One axis along the longest edge of the first triangle, one along its normal. Precondition: not
  /// empty, coordinates finite and below kLargestCoordinate_m.
  explicit OrientedBox(std::span<const Triangle> body);

  /// A lower bound of the squared distance between anything in the box and `triangle`: the larger
  /// of what the axes of the box and the plane of the triangle show. With d the true distance and
  /// `scale_m` as in `triangle_distance_error_m(scale_m)`, it is at most
  /// (d + triangle_distance_error_m(scale_m))²·(1 + kRelativeError).
  [[nodiscard]] double squared_distance_bound_m2(const Triangle& triangle) const;

  /// Three squares and two sums.
  static constexpr double kRelativeError = 0x1p-50;

 private:
  [[nodiscard]] double axes_bound_m2(const Triangle& triangle) const;
  [[nodiscard]] double plane_bound_m(const Triangle& triangle) const;

  Vec3 origin_ = Vec3::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< columns
  Vec3 low_ = Vec3::Zero();                             ///< along the axes, from the origin
  Vec3 high_ = Vec3::Zero();
};

}  // namespace camway::geometry
