// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Largest coordinate of a point of a hull.
inline constexpr double kLargestHullCoordinate_m = 1e9;

/// Points whose relative positions are decided without rounding: in doubles where their error bound
/// allows it (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates", section 4.3), otherwise in integers of any length. Refers to `points`,
/// which must outlive it. Requires coordinates to be finite and at most
/// `kLargestHullCoordinate_m`.
class ExactPoints {
 public:
  explicit ExactPoints(std::span<const Vec3> points);
  ~ExactPoints();
  ExactPoints(const ExactPoints&) = delete;
  ExactPoints& operator=(const ExactPoints&) = delete;

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const Vec3& operator[](std::size_t i) const { return points_[i]; }

  /// The side of the plane through a, b and c on which point d lies: 1 on the side to which (b - a)
  /// × (c - a) points, -1 on the other, 0 in the plane, or if the three points define no plane.
  [[nodiscard]] int side(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const;

  /// Whether the three points lie on one line.
  [[nodiscard]] bool collinear(std::size_t a, std::size_t b, std::size_t c) const;

  /// Sense of rotation of a, b, c seen along coordinate `axis`: 1, -1, or 0 if they are collinear
  /// in that view.
  [[nodiscard]] int turn(std::size_t a, std::size_t b, std::size_t c, std::size_t axis) const;

  /// Unit vector along (b - a) × (c - a), of unit length to within 4·2^-53, however thin the
  /// triangle. Each coordinate is within 2^-51 of the true one. Requires that the points are not
  /// collinear.
  [[nodiscard]] Vec3 unit_normal(std::size_t a, std::size_t b, std::size_t c) const;

 private:
  struct Integers;  ///< the points, times a common power of two

  std::span<const Vec3> points_;
  std::unique_ptr<const Integers> integers_;
};

}  // namespace camway::geometry
