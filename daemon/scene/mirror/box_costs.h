// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

/// Costs of boxes, for searches that find the cheapest of many boxes in a tree of boxes. A cost is,
/// rounding included, a lower bound of the true cost of the box, and the true cost of a box is
/// never more than that of a box inside it. So a search that skips boxes whose cost is at least
/// that of the best one found so far returns a number that no box in the tree truly undercuts.
///
/// A cost is computed in two steps, `along` each axis and the `total` of three axes, because the
/// eight octants of a box have only two extents on each axis. `bound`, for the inner boxes of the
/// tree, is also a lower bound of the true cost, and may be cheaper to compute.
/// Value types. Thread-safe.
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
  /// Distance on one axis.
  using Part = double;

  /// Requires a finite point.
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
  /// Where the ray is between two planes; nowhere if `enter` exceeds `leave`.
  struct Part {
    double enter;
    double leave;
  };

  /// Requires finite arguments, and a `direction` that is not zero.
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
  /// Whether they touch on one axis.
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

/// Distance that the centre of a ball travels along a segment until the ball first touches a box;
/// infinite if it never does.
///
/// The distance f(t) of the centre from the box is a convex function of the travelled distance t.
/// So Newton's method for f(t) = radius, started where f exceeds the radius, approaches the first
/// solution from below and never passes it. Every iterate is a lower bound, wherever the iteration
/// stops and even if a step is too short. If f no longer falls and still exceeds the radius, there
/// is no solution.
class BallWay {
 public:
  /// Offsets from the start of the segment to both ends of a box on one axis, and the larger
  /// magnitude.
  struct Part {
    double to_low;
    double to_high;
    double reach;
  };

  /// Requires finite arguments and radius_m >= 0.
  BallWay(const geometry::Vec3& from, const geometry::Vec3& to, double radius_m);
  [[nodiscard]] Part along(Eigen::Index axis, double low, double high) const {
    const double to_low = low - from_[axis];
    const double to_high = high - from_[axis];
    return {to_low, to_high, std::max(std::abs(to_low), std::abs(to_high))};
  }
  [[nodiscard]] double total(const Part& x, const Part& y, const Part& z) const;
  /// Like `total`, but with few iterations.
  [[nodiscard]] double bound(const Part& x, const Part& y, const Part& z) const;

  /// Length of the segment. A greater cost means that the ball does not touch the box. Infinite if
  /// it overflows; then all boxes cost 0.
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  [[nodiscard]] double way_m(const Part& x, const Part& y, const Part& z, int steps) const;

  geometry::Vec3 from_;
  geometry::Vec3 direction_;  ///< unit vector but for rounding; zero for a segment without length
  double radius_m_;
  double length_m_ = 0.0;
};

}  // namespace camway::scene
