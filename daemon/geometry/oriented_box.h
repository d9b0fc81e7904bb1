// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// A box around triangles, along their own directions: it fits a quadrilateral or a rotated box
/// without slack. For cheap proofs that a triangle is far away. A value type. Thread-safe for const
/// calls.
class OrientedBox {
 public:
  OrientedBox() = default;
  /// A box with one axis along the longest edge of the first triangle and one along its normal.
  /// Requires a triangle or more, with coordinates finite and below kLargestCoordinate_m.
  explicit OrientedBox(std::span<const Triangle> body);
  /// A box around `body` along the axes of this one, which saves computing new ones. Requires the
  /// same, and that this box was not default-constructed.
  [[nodiscard]] OrientedBox around(std::span<const Triangle> body) const;

  /// A lower bound of the squared distance between any point of the box and `triangle`: the larger
  /// of the bounds from the axes of the box and from the plane of the triangle. With d the true
  /// distance and `scale_m` as in `triangle_distance_error_m(scale_m)`, it is at most (d +
  /// triangle_distance_error_m(scale_m))²·(1 + kRelativeError).
  [[nodiscard]] double squared_distance_bound_m2(const Triangle& triangle) const;

  /// Relative rounding of a squared length (6 roundings of 2^-53), a square and a quotient.
  static constexpr double kRelativeError = 0x1p-49;

  /// The point that the extents along the axes are measured from.
  [[nodiscard]] const Vec3& origin() const { return origin_; }
  /// Unit vector `k` of three.
  [[nodiscard]] Vec3 axis(int k) const { return {x_[k], y_[k], z_[k]}; }
  [[nodiscard]] double low_m(int k) const { return low_[k]; }
  [[nodiscard]] double high_m(int k) const { return high_[k]; }

  /// The bound from the axes of the box alone.
  [[nodiscard]] double axes_bound_m2(const Triangle& triangle) const;
  /// The bound from the plane of the triangle alone.
  [[nodiscard]] double plane_bound_m2(const Triangle& triangle) const;

  /// The bounds of two boxes.
  struct TwoBounds {
    std::array<double, 2> axes_m2;
    std::array<double, 2> plane_m2;
  };
  /// Computes both bounds of two boxes about parts of this one's body, bit for bit as the functions
  /// above do, and faster. Returns false, and no bounds, if the plane bound of this box is above
  /// `most_m2`. Requires that `around` of this box made both.
  bool bound_two(std::span<const OrientedBox, 2> parts, const Triangle& triangle, double most_m2,
                 TwoBounds& out) const;

 private:
  void fit(std::span<const Triangle> body);

  /// Four numbers instead of three, since processors handle two or four at a time.
  using Lanes = Eigen::Array4d;

  Vec3 origin_ = Vec3::Zero();
  Lanes x_ = Lanes::Zero();  ///< x coordinates of the three axes
  Lanes y_ = Lanes::Zero();
  Lanes z_ = Lanes::Zero();
  Lanes low_ = Lanes::Zero();  ///< extents along the axes, from the origin
  Lanes high_ = Lanes::Zero();
};

}  // namespace camway::geometry
