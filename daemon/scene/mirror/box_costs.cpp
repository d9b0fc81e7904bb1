// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/box_costs.h"

#include <algorithm>
#include <cmath>

namespace camway::scene {
namespace {

using geometry::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundDown = kBoxCostRoundDown;
constexpr double kRoundUp = kBoxCostRoundUp;

/// Most steps of Newton's method. Head-on one is enough; if the ball only grazes the box each step
/// halves the rest, so the result is short by a billionth.
constexpr int kMaxSteps = 32;

/// Steps for a bound: the first shows which boxes are out of reach, the next two which ones the
/// segment passes by. (Along a segment of kilometres two steps recognise hardly any of these, three
/// all but 2 %.)
constexpr int kBoundSteps = 3;

/// Rounding error of a gap along an axis, in units of 2^-53 of the sum of two lengths: the distance
/// of the box's farthest coordinate from the start, and the length of the segment. The direction is
/// off by 5 (difference of the ends 1, length 3, division 1), its product with the travelled
/// distance by 1 more; the box relative to the start by 1; the difference of the two by 1. Doubled.
constexpr double kGapRoundoffs = 16.0;

/// At least the length of a vector of three ones: the error of a distance made of three gaps.
constexpr double kNormOfThree = 2.0;

}  // namespace

RayEntry::RayEntry(const Vec3& origin, const Vec3& direction) : origin_(origin) {
  // Exact scaling by a power of two: the length then neither overflows nor underflows, and the
  // direction is not turned by a rounded division.
  const int exponent = std::ilogb(direction.cwiseAbs().maxCoeff());
  for (Eigen::Index i = 0; i < 3; ++i) direction_[i] = std::scalbn(direction[i], -exponent);
  length_ = direction_.norm();
}

BallWay::BallWay(const Vec3& from, const Vec3& to, double radius_m)
    : from_(from), direction_(Vec3::Zero()), radius_m_(radius_m) {
  const Vec3 way = to - from;
  const double largest = way.cwiseAbs().maxCoeff();
  if (largest == 0.0) return;
  // Scaled as for rays.
  const int exponent = std::isfinite(largest) ? std::ilogb(largest) : 0;
  for (Eigen::Index i = 0; i < 3; ++i) direction_[i] = std::scalbn(way[i], -exponent);
  const double length = direction_.norm();
  direction_ /= length;
  length_m_ = std::scalbn(length, exponent) * kRoundUp;
}

double BallWay::total(const Part& x, const Part& y, const Part& z) const {
  return way_m(x, y, z, kMaxSteps);
}

double BallWay::bound(const Part& x, const Part& y, const Part& z) const {
  return way_m(x, y, z, kBoundSteps);
}

double BallWay::way_m(const Part& x, const Part& y, const Part& z, int steps) const {
  if (!std::isfinite(length_m_)) return 0.0;
  const double reach_m = std::max(std::max(x.reach, y.reach), z.reach) + length_m_;
  const double error_m = kGapRoundoffs * geometry::kUnitRoundoff * reach_m;
  // Signed gap to the box on an axis: positive below it, negative above, 0 between.
  const auto gap = [](const Part& part, double along) {
    return std::max(part.to_low - along, 0.0) - std::max(along - part.to_high, 0.0);
  };
  double way_m = 0.0;
  for (int step = 0; step < steps; ++step) {
    const Vec3 along = way_m * direction_;
    const Vec3 gaps(gap(x, along.x()), gap(y, along.y()), gap(z, along.z()));
    const double distance_m = box_cost_length(gaps.x(), gaps.y(), gaps.z());
    const double room_m = distance_m * kRoundDown - kNormOfThree * error_m - radius_m_;
    if (!(room_m > 0.0)) break;
    // Upper bound of the closing speed, which never exceeds the ball's own.
    const Vec3 share = gaps / distance_m;
    const double closing = std::min(
        kRoundUp, share.dot(direction_) + 2.0 * kNormOfThree * error_m / distance_m + kRoundUp - 1);
    if (!(closing > 0.0)) return kInfinity;
    way_m += room_m / closing * kRoundDown;
    if (way_m > length_m_) return kInfinity;
  }
  return way_m * kRoundDown;
}

}  // namespace camway::scene
