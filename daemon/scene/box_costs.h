// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

/// What it costs to get to a box, for searches that look for the cheapest of many boxes in a tree
/// of boxes. Each is, rounding included, a lower bound of the true cost of the box, which is never
/// more than that of a box inside it: then a search that leaves out boxes that cost at least as
/// much as the best found so far gives a number that no box in the tree truly undercuts. Value
/// types, safe from any thread.
namespace camway::scene {

/// Costs are rounded down by up to this factor: ten roundings of half an ulp, doubled.
inline constexpr double kBoxCostRelativeError = 20 * geometry::kUnitRoundoff;

/// Distance from a point to a box.
class PointDistance {
 public:
  /// Precondition: finite.
  explicit PointDistance(const geometry::Vec3& point) : point_(point) {}
  double operator()(const geometry::Box& box) const;

 private:
  geometry::Vec3 point_;
};

/// Distance along a ray to where it enters a box; infinite if it misses.
class RayEntry {
 public:
  /// Precondition: finite, and `direction` is not zero.
  RayEntry(const geometry::Vec3& origin, const geometry::Vec3& direction);
  double operator()(const geometry::Box& box) const;

 private:
  geometry::Vec3 origin_;
  geometry::Vec3 direction_;
  double length_ = 1.0;
};

/// 0 if two closed boxes touch, else infinite.
class BoxTouch {
 public:
  explicit BoxTouch(const geometry::Box& box) : box_(box) {}
  double operator()(const geometry::Box& other) const {
    return box_.intersects(other) ? 0.0 : std::numeric_limits<double>::infinity();
  }

 private:
  geometry::Box box_;
};

/// Way of a ball's centre along a segment to where the ball first touches a box; infinite if it
/// never does.
///
/// The distance f of the moving centre from a box is a convex function of the way t. So Newton's
/// method for f(t) = radius, begun where the distance is more than that, comes near to the first
/// solution from below and never passes it: every step is a lower bound already, and it does not
/// matter for that when one stops, or if a step is shorter than it should be. Where f does not fall
/// any more and is still above the radius, there is no solution.
class BallWay {
 public:
  /// Precondition: finite; radius_m >= 0.
  BallWay(const geometry::Vec3& from, const geometry::Vec3& to, double radius_m);
  double operator()(const geometry::Box& box) const;

  /// A cost above this is that of a box that the ball does not touch. Infinite if the segment is so
  /// long that its length overflows; then every box costs nothing.
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  geometry::Vec3 from_;
  geometry::Vec3
      direction_;  ///< of unit length but for rounding; zero for a segment without length
  double radius_m_;
  double length_m_ = 0.0;
};

}  // namespace camway::scene
