// SPDX-License-Identifier: MIT
#include "daemon/geometry/exact_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "daemon/geometry/exact_integers.h"
#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

int lowest_exponent_of(std::span<const Vec3> points) {
  int lowest = std::numeric_limits<int>::max();
  for (const Vec3& point : points) {
    for (const double x : point) {
      if (x != 0.0) lowest = std::min(lowest, lowest_exponent(x));
    }
  }
  return lowest;
}

/// (7 + 56·2^-53)·2^-53: Shewchuk's bound, relative to the sum of the magnitudes of all products.
constexpr double kVolumeRounding = (7.0 + 56.0 * geometry::kUnitRoundoff) * geometry::kUnitRoundoff;

/// Volume of the parallelepiped of three edges, with a bound of its error if the edges are
/// differences of points. Each product that underflows loses at most 2^-1075 times an edge, which
/// the smallest normal number covers for edges up to 2^31 m.
struct Volume {
  double value;
  double error;
};
Volume volume(const Vec3& e, const Vec3& f, const Vec3& g) {
  const Vec3 normal = e.cross(f);
  const Vec3 magnitude(std::abs(e.y() * f.z()) + std::abs(e.z() * f.y()),
                       std::abs(e.z() * f.x()) + std::abs(e.x() * f.z()),
                       std::abs(e.x() * f.y()) + std::abs(e.y() * f.x()));
  return {normal.dot(g), kVolumeRounding * magnitude.dot(g.cwiseAbs()) + geometry::kSmallestNormal};
}

}  // namespace

struct ExactPoints::Integers {
  std::vector<IntegerVec> points;

  [[nodiscard]] IntegerVec normal(std::size_t a, std::size_t b, std::size_t c) const {
    return cross(difference(points[b], points[a]), difference(points[c], points[a]));
  }
};

ExactPoints::ExactPoints(std::span<const Vec3> points) : points_(points) {
  const int unit_exponent = lowest_exponent_of(points);
  auto integers = std::make_unique<Integers>();
  integers->points.reserve(points.size());
  for (const Vec3& point : points) {
    integers->points.push_back({to_integer(point.x(), unit_exponent),
                                to_integer(point.y(), unit_exponent),
                                to_integer(point.z(), unit_exponent)});
  }
  integers_ = std::move(integers);
}

ExactPoints::~ExactPoints() = default;

int ExactPoints::side(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
  const Volume v =
      volume(points_[b] - points_[a], points_[c] - points_[a], points_[d] - points_[a]);
  if (std::abs(v.value) > v.error) return v.value > 0.0 ? 1 : -1;
  const IntegerVec normal = integers_->normal(a, b, c);
  const IntegerVec edge = difference(integers_->points[d], integers_->points[a]);
  const Integer exact = normal[0] * edge[0] + normal[1] * edge[1] + normal[2] * edge[2];
  return exact.sign();
}

bool ExactPoints::collinear(std::size_t a, std::size_t b, std::size_t c) const {
  return is_zero(integers_->normal(a, b, c));
}

int ExactPoints::turn(std::size_t a, std::size_t b, std::size_t c, std::size_t axis) const {
  return integers_->normal(a, b, c)[axis].sign();
}

Vec3 ExactPoints::unit_normal(std::size_t a, std::size_t b, std::size_t c) const {
  // Truncation to the 62 leading bits of the largest coordinate loses less than 2^-61 of it; then
  // one rounding to double (2^-53), and three of a normalised vector (2^-53 each, and its length).
  constexpr unsigned kBits = 62;
  const IntegerVec normal = integers_->normal(a, b, c);
  unsigned bits = 0;
  for (const Integer& x : normal) {
    if (!x.is_zero()) bits = std::max(bits, static_cast<unsigned>(msb(abs(x))) + 1);
  }
  const unsigned cut = bits > kBits ? bits - kBits : 0;
  Vec3 direction;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto leading = static_cast<std::int64_t>(Integer(abs(normal[k]) >> cut));
    direction[static_cast<Eigen::Index>(k)] =
        static_cast<double>(normal[k].sign()) * static_cast<double>(leading);
  }
  return direction.normalized();
}

}  // namespace camway::geometry
