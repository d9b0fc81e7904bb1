// SPDX-License-Identifier: MIT
#include "daemon/scene/box_costs.h"

#include <algorithm>
#include <cmath>

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundDown = 1.0 - kBoxCostRelativeError / 2.0;
constexpr double kRoundUp = 1.0 + kBoxCostRelativeError;

double length_of(const Vec3& v) {
  const double length = std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
  return std::isfinite(length) ? length : std::hypot(v.x(), v.y(), v.z());
}

/// Newton's steps that are made at most. Head-on one is enough; where the ball just grazes each
/// halves what is left, so that after these the answer is short by a billionth.
constexpr int kMaxSteps = 32;

/// By how many units of 2^-53 a gap along an axis is off, of the farthest coordinate of the box
/// from the beginning of the way, and the way's length: the direction by 5 (difference of the ends
/// 1, length 3, division 1), its product with the way by 1 more; the box from the beginning by 1;
/// the difference of the two by 1. Doubled.
constexpr double kGapRoundoffs = 16.0;

/// At least the length of a vector of three ones: what three gaps that are off come to.
constexpr double kNormOfThree = 2.0;

}  // namespace

double PointDistance::operator()(const Box& box) const {
  const auto gap = [&](Eigen::Index i) {
    return std::max({0.0, box.min()[i] - point_[i], point_[i] - box.max()[i]});
  };
  return length_of({gap(0), gap(1), gap(2)}) * kRoundDown;
}

RayEntry::RayEntry(const Vec3& origin, const Vec3& direction) : origin_(origin) {
  // Exact scaling by a power of two: the length then neither overflows nor underflows, and the
  // direction is not turned by a rounded division.
  const int exponent = std::ilogb(direction.cwiseAbs().maxCoeff());
  for (Eigen::Index i = 0; i < 3; ++i) direction_[i] = std::scalbn(direction[i], -exponent);
  length_ = direction_.norm();
}

double RayEntry::operator()(const Box& box) const {
  double enter = 0.0;
  double leave = kInfinity;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (direction_[i] == 0.0) {
      if (origin_[i] < box.min()[i] || origin_[i] > box.max()[i]) return kInfinity;
      continue;
    }
    const double to_min = (box.min()[i] - origin_[i]) / direction_[i];
    const double to_max = (box.max()[i] - origin_[i]) / direction_[i];
    enter = std::max(enter, std::min(to_min, to_max));
    leave = std::min(leave, std::max(to_min, to_max));
  }
  // Each side carries two roundings; a ray through an edge or corner must not slip between them.
  if (enter * kRoundDown > leave * kRoundUp) return kInfinity;
  return enter * length_ * kRoundDown;
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

double BallWay::operator()(const Box& box) const {
  if (!std::isfinite(length_m_)) return 0.0;
  const Vec3 to_min = box.min() - from_;
  const Vec3 to_max = box.max() - from_;
  const double reach_m =
      std::max(to_min.cwiseAbs().maxCoeff(), to_max.cwiseAbs().maxCoeff()) + length_m_;
  const double error_m = kGapRoundoffs * geometry::kUnitRoundoff * reach_m;
  double way_m = 0.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec3 along = way_m * direction_;
    const Vec3 below = (to_min - along).cwiseMax(0.0);
    const Vec3 above = (along - to_max).cwiseMax(0.0);
    const double distance_m = length_of(below + above);
    const double room_m = distance_m * kRoundDown - kNormOfThree * error_m - radius_m_;
    if (!(room_m > 0.0)) break;
    // How fast it comes nearer, at most; never faster than it moves.
    const Vec3 share = (below - above) / distance_m;
    const double closing = std::min(
        kRoundUp, share.dot(direction_) + 2.0 * kNormOfThree * error_m / distance_m + kRoundUp - 1);
    if (!(closing > 0.0)) return kInfinity;
    way_m += room_m / closing * kRoundDown;
    if (way_m > length_m_) return kInfinity;
  }
  return way_m * kRoundDown;
}

}  // namespace camway::scene
