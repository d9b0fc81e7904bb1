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
  /// A box around `body` along the axes of this one, which spares finding some. Preconditions: the
  /// same, and this is not default-constructed.
  [[nodiscard]] OrientedBox around(std::span<const Triangle> body) const;

  /// A lower bound of the squared distance between anything in the box and `triangle`: the larger
  /// of what the axes of the box and the plane of the triangle show. With d the true distance and
  /// `scale_m` as in `triangle_distance_error_m(scale_m)`, it is at most
  /// (d + triangle_distance_error_m(scale_m))²·(1 + kRelativeError).
  [[nodiscard]] double squared_distance_bound_m2(const Triangle& triangle) const;

  /// A squared length (6 roundings of 2^-53), a square and a quotient.
  static constexpr double kRelativeError = 0x1p-49;

  /// A point that the extents along the axes are measured from.
  [[nodiscard]] const Vec3& origin() const { return origin_; }
  /// Unit vector `k` of three.
  [[nodiscard]] Vec3 axis(int k) const { return {x_[k], y_[k], z_[k]}; }
  [[nodiscard]] double low_m(int k) const { return low_[k]; }
  [[nodiscard]] double high_m(int k) const { return high_[k]; }

  /// What the axes of the box alone show.
  [[nodiscard]] double axes_bound_m2(const Triangle& triangle) const;
  /// What the plane of the triangle alone shows.
  [[nodiscard]] double plane_bound_m2(const Triangle& triangle) const;

 private:
  void fit(std::span<const Triangle> body);

  /// Four numbers where three would do, since processors take them two or four at a time.
  using Lanes = Eigen::Array4d;

  [[nodiscard]] Lanes along_axes(const Vec3& v) const {
    return x_ * v.x() + y_ * v.y() + z_ * v.z();
  }

  Vec3 origin_ = Vec3::Zero();
  Lanes x_ = Lanes::Zero();  ///< of the three axes
  Lanes y_ = Lanes::Zero();
  Lanes z_ = Lanes::Zero();
  Lanes low_ = Lanes::Zero();  ///< along the axes, from the origin
  Lanes high_ = Lanes::Zero();
};

}  // namespace camway::geometry
