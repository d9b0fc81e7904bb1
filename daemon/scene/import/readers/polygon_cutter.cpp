// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/polygon_cutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/polygon_holes.h"

namespace camway::scene::mesh_readers {
namespace {

using Point2 = std::array<double, 2>;

/// Twice the area vector, relative to the first corner, so that a small polygon far from the origin
/// keeps its precision.
Point area_vector(std::span<const Point> corners) {
  Point sum = {0.0, 0.0, 0.0};
  const Point& origin = corners[0];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    Point a;
    Point b;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = corners[i][k] - origin[k];
      b[k] = corners[i + 1][k] - origin[k];
    }
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

/// A sum of doubles without rounding, as terms that do not overlap (Shewchuk 1997, figure 3).
class ExactSum {
 public:
  void add(double term) {
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = parts_[i] + term;
      const double virtual_term = sum - parts_[i];
      parts_[i] = (parts_[i] - (sum - virtual_term)) + (term - virtual_term);
      term = sum;
    }
    parts_[size_++] = term;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  /// Returns a number with the sign of the sum: the largest term decides it.
  [[nodiscard]] double leading() const {
    for (std::size_t i = size_; i > 0; --i) {
      if (parts_[i - 1] != 0.0) return parts_[i - 1];
    }
    return 0.0;
  }

 private:
  std::array<double, 12> parts_{};
  std::size_t size_ = 0;
};

}  // namespace

double orientation(const Point2& a, const Point2& b, const Point2& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]);
  const double right = (b[1] - a[1]) * (c[0] - a[0]);
  const double turn = left - right;
  // Shewchuk 1997, the first bound of his orient2d.
  constexpr double kUnitRoundoff = geometry::kUnitRoundoff;
  constexpr double kBound = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
  if (std::abs(turn) > kBound * (std::abs(left) + std::abs(right))) return turn;
  ExactSum sum;
  sum.add_product(a[0], b[1]);
  sum.add_product(-a[1], b[0]);
  sum.add_product(b[0], c[1]);
  sum.add_product(-b[1], c[0]);
  sum.add_product(c[0], a[1]);
  sum.add_product(-c[1], a[0]);
  return sum.leading();
}

std::span<const PolygonCutter::Cut> PolygonCutter::cut(std::span<const Point> corners) {
  cuts_.clear();
  if (corners.size() == 3) {
    cuts_.push_back({0, 1, 2});
    return cuts_;
  }
  project(corners, corners.size());
  if (corners.size() == 4) {
    cut_quadrilateral();
  } else {
    cut_ears();
  }
  return cuts_;
}

std::span<const PolygonCutter::Cut> PolygonCutter::cut(std::span<const Point> corners,
                                                       std::span<const std::size_t> ends) {
  if (ends.size() == 1) return cut(corners);
  cuts_.clear();
  project(corners, ends[0]);
  const std::vector<std::uint32_t> ring = ring_with_holes(points_, ends);
  if (ring.empty()) return cuts_;
  std::vector<Point2> ring_points;
  for (const std::uint32_t corner : ring) ring_points.push_back(points_[corner]);
  points_ = std::move(ring_points);
  cut_ears();
  for (Cut& cut : cuts_) {
    for (std::uint32_t& corner : cut) corner = ring[corner];
  }
  return cuts_;
}

void PolygonCutter::project(std::span<const Point> corners, std::size_t outline) {
  const Point normal = area_vector(corners.first(outline));
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  std::size_t x = (axis + 1) % 3;
  std::size_t y = (axis + 2) % 3;
  if (normal[axis] < 0.0) std::swap(x, y);
  points_.clear();
  for (const Point& corner : corners) points_.push_back({corner[x], corner[y]});
}

double PolygonCutter::turn(Index a, Index b, Index c) const {
  return orientation(points_[a], points_[b], points_[c]);
}

double PolygonCutter::turn_at(Index corner) const {
  return turn(before_[corner], corner, after_[corner]);
}

/// The diagonal from the first corner, unless a corner beside it is not convex: at most one corner
/// is.
void PolygonCutter::cut_quadrilateral() {
  if (turn(0, 1, 2) > 0.0 && turn(2, 3, 0) > 0.0) {
    cuts_.push_back({0, 1, 2});
    cuts_.push_back({0, 2, 3});
  } else {
    cuts_.push_back({1, 2, 3});
    cuts_.push_back({1, 3, 0});
  }
}

void PolygonCutter::link() {
  const auto count = static_cast<Index>(points_.size());
  before_.resize(count);
  after_.resize(count);
  for (Index i = 0; i < count; ++i) {
    before_[i] = i == 0 ? count - 1 : i - 1;
    after_[i] = i + 1 == count ? 0 : i + 1;
  }
  reflex_.clear();
  for (Index i = 0; i < count; ++i) {
    if (!(turn_at(i) > 0.0)) reflex_.push_back(i);
  }
}

/// Tries the corners in order from the first; after an ear it goes on with the next corner.
void PolygonCutter::cut_ears() {
  link();
  std::size_t remaining = points_.size();
  std::size_t misses = 0;
  Index corner = 0;
  while (remaining > 3 && misses < remaining) {
    const Index next = after_[corner];
    if (is_ear(corner)) {
      cuts_.push_back({before_[corner], corner, next});
      unlink(corner);
      --remaining;
      misses = 0;
    } else {
      ++misses;
    }
    corner = next;
  }
  cut_fan(corner, remaining);
}

void PolygonCutter::cut_fan(Index first, std::size_t remaining) {
  Index corner = after_[first];
  for (std::size_t i = 2; i < remaining; ++i) {
    cuts_.push_back({first, corner, after_[corner]});
    corner = after_[corner];
  }
}

void PolygonCutter::unlink(Index ear) {
  after_[before_[ear]] = after_[ear];
  before_[after_[ear]] = before_[ear];
  // A convex corner stays convex when its neighbour goes; one that was not may become so.
  std::erase_if(reflex_, [&](Index corner) {
    const bool beside = corner == before_[ear] || corner == after_[ear];
    return corner == ear || (beside && turn_at(corner) > 0.0);
  });
}

bool PolygonCutter::is_ear(Index corner) const {
  const Cut ear = {before_[corner], corner, after_[corner]};
  if (!(turn(ear[0], ear[1], ear[2]) > 0.0)) return false;
  return std::none_of(reflex_.begin(), reflex_.end(),
                      [&](Index other) { return encloses(ear, other); });
}

/// A corner at the same place as one of the ear's own does not count: outlines that lead to a hole
/// and back pass through a point twice.
bool PolygonCutter::encloses(const Cut& ear, Index corner) const {
  const Point2& point = points_[corner];
  for (const Index own : ear) {
    if (point == points_[own]) return false;
  }
  return turn(ear[0], ear[1], corner) >= 0.0 && turn(ear[1], ear[2], corner) >= 0.0 &&
         turn(ear[2], ear[0], corner) >= 0.0;
}

}  // namespace camway::scene::mesh_readers
