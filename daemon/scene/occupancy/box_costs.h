// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

/// What it costs to get to a box, for searches that look for the cheapest of many boxes in a tree
/// of boxes. Each is, rounding included, a lower bound of the true cost of the box, which is never
/// more than that of a box inside it: then a search that leaves out boxes that cost at least as
/// much as the best found so far gives a number that no box in the tree truly undercuts.
///
/// A cost is asked for in two steps, `along` each axis and the `total` of three axes, as the eight
/// octants of a box have but two extents on each axis. `bound` is never more than the true cost
/// either, and may be cheaper: for boxes that are only ways to others. Value types, safe from any
/// thread.
namespace camway::scene {

/// Costs are rounded down by up to this factor: ten roundings of half an ulp, doubled.
inline constexpr double kBoxCostRelativeError = 20 * geometry::kUnitRoundoff;
inline constexpr double kBoxCostRoundDown = 1.0 - kBoxCostRelativeError / 2.0;
inline constexpr double kBoxCostRoundUp = 1.0 + kBoxCostRelativeError;

/// Length of a vector, without overflow.
inline double box_cost_length(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return std::isfinite(length) ? length : std::hypot(x, y, z);
}

/// Distance from a point to a box.
class PointDistance {
 public:
  /// The gap on one axis.
  using Part = double;

  /// Precondition: finite.
  explicit PointDistance(const geometry::Vec3& point) : point_(point) {}
  [[nodiscard]] Part along(Eigen::Index axis, double low, double high) const {
    return std::max(std::max(0.0, low - point_[axis]), point_[axis] - high);
  }
  [[nodiscard]] double total(Part x, Part y, Part z) const {
    return box_cost_length(x, y, z) * kBoxCostRoundDown;
  }
  [[nodiscard]] double bound(Part x, Part y, Part z) const { return total(x, y, z); }

 private:
  geometry::Vec3 point_;
};

/// Distance along a ray to where it enters a box; infinite if it misses.
class RayEntry {
 public:
  /// Where the ray is between two planes; nowhere if it enters after it leaves.
  struct Part {
    double enter;
    double leave;
  };

  /// Precondition: finite, and `direction` is not zero.
  RayEntry(const geometry::Vec3& origin, const geometry::Vec3& direction);
  [[nodiscard]] Part along(Eigen::Index axis, double low, double high) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (direction_[axis] == 0.0) {
      const bool beside = origin_[axis] < low || origin_[axis] > high;
      return beside ? Part{kInfinity, -kInfinity} : Part{0.0, kInfinity};
    }
    const double to_low = (low - origin_[axis]) / direction_[axis];
    const double to_high = (high - origin_[axis]) / direction_[axis];
    return {std::min(to_low, to_high), std::max(to_low, to_high)};
  }
  [[nodiscard]] double total(const Part& x, const Part& y, const Part& z) const {
    const double enter = std::max(std::max(std::max(0.0, x.enter), y.enter), z.enter);
    const double leave = std::min(std::min(x.leave, y.leave), z.leave);
    // Each side carries two roundings; a ray through an edge or corner must not slip between them.
    const bool missed = enter * kBoxCostRoundDown > leave * kBoxCostRoundUp;
    return missed ? std::numeric_limits<double>::infinity() : enter * length_ * kBoxCostRoundDown;
  }
  [[nodiscard]] double bound(const Part& x, const Part& y, const Part& z) const {
    return total(x, y, z);
  }

 private:
  geometry::Vec3 origin_;
  geometry::Vec3 direction_;
  double length_ = 1.0;
};

/// 0 if two closed boxes touch, else infinite.
class BoxTouch {
 public:
  /// Whether they do on one axis.
  using Part = bool;

  explicit BoxTouch(const geometry::Box& box) : box_(box) {}
  [[nodiscard]] Part along(Eigen::Index axis, double low, double high) const {
    return box_.min()[axis] <= high && low <= box_.max()[axis];
  }
  [[nodiscard]] double total(Part x, Part y, Part z) const {
    return x && y && z ? 0.0 : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double bound(Part x, Part y, Part z) const { return total(x, y, z); }

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
  /// From the beginning of the way to both ends of a box on one axis, and the larger of the two.
  struct Part {
    double to_low;
    double to_high;
    double reach;
  };

  /// Precondition: finite; radius_m >= 0.
  BallWay(const geometry::Vec3& from, const geometry::Vec3& to, double radius_m);
  [[nodiscard]] Part along(Eigen::Index axis, double low, double high) const {
    const double to_low = low - from_[axis];
    const double to_high = high - from_[axis];
    return {to_low, to_high, std::max(std::abs(to_low), std::abs(to_high))};
  }
  [[nodiscard]] double total(const Part& x, const Part& y, const Part& z) const;
  /// Of a few steps.
  [[nodiscard]] double bound(const Part& x, const Part& y, const Part& z) const;

  /// A cost above this is that of a box that the ball does not touch. Infinite if the segment is so
  /// long that its length overflows; then every box costs nothing.
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  [[nodiscard]] double way_m(const Part& x, const Part& y, const Part& z, int steps) const;

  geometry::Vec3 from_;
  geometry::Vec3
      direction_;  ///< of unit length but for rounding; zero for a segment without length
  double radius_m_;
  double length_m_ = 0.0;
};

}  // namespace camway::scene
