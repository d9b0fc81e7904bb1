// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::motion {

/// Points whose mutual position is judged without rounding: doubles decide where their error bound
/// allows it (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates", section 4.3), integers of any length decide the rest. Refers to `points`,
/// which must outlive it. Precondition: coordinates are finite and at most kMaxBodyCoordinate_m.
class ExactPoints {
 public:
  explicit ExactPoints(std::span<const geometry::Vec3> points);
  ~ExactPoints();
  ExactPoints(const ExactPoints&) = delete;
  ExactPoints& operator=(const ExactPoints&) = delete;

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const geometry::Vec3& operator[](std::size_t i) const { return points_[i]; }

  /// On which side of the plane through a, b and c point d lies: 1 on the one to which
  /// (b - a) × (c - a) points, -1 on the other, 0 in the plane, or if there is no one plane.
  [[nodiscard]] int side(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const;

  /// Whether the three lie on one line.
  [[nodiscard]] bool collinear(std::size_t a, std::size_t b, std::size_t c) const;

  /// Sense of rotation of a, b, c, seen along coordinate `axis`: 1, -1, or 0 if they are on a line
  /// there.
  [[nodiscard]] int turn(std::size_t a, std::size_t b, std::size_t c, std::size_t axis) const;

  /// Direction of (b - a) × (c - a), of unit length to within 4·2^-53, however thin the triangle.
  /// Each coordinate is within 2^-51 of the true one. Precondition: not collinear.
  [[nodiscard]] geometry::Vec3 unit_normal(std::size_t a, std::size_t b, std::size_t c) const;

 private:
  struct Integers;  ///< the points, times a common power of two

  std::span<const geometry::Vec3> points_;
  std::unique_ptr<const Integers> integers_;
};

}  // namespace camway::motion
