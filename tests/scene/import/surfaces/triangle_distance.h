// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::testing {

/// Distance of a point from a triangle, which may have no area.
inline double distance_to_triangle(const geometry::Vec3& p, const geometry::Vec3& a,
                                   const geometry::Vec3& b, const geometry::Vec3& c) {
  using geometry::Vec3;
  const Vec3 n = (b - a).cross(c - a);
  const auto inside = [&](const Vec3& x, const Vec3& y) {
    return (y - x).cross(p - x).dot(n) >= 0.0;
  };
  if (n.squaredNorm() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    return std::abs((p - a).dot(n)) / n.norm();
  }
  const auto to_edge = [&](const Vec3& x, const Vec3& y) {
    const double square = (y - x).squaredNorm();
    const double t = square > 0.0 ? std::clamp((p - x).dot(y - x) / square, 0.0, 1.0) : 0.0;
    return (p - x - t * (y - x)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// Triangles in cells of a grid, for many distances that are short.
class NearTriangles {
 public:
  /// Distances up to `reach` are found. Requires a positive reach.
  explicit NearTriangles(double reach) : reach_(reach) {}

  void add(const geometry::Vec3& a, const geometry::Vec3& b, const geometry::Vec3& c) {
    triangles_.push_back({a, b, c});
    longest_ = std::max({longest_, (a - b).norm(), (b - c).norm(), (c - a).norm()});
  }

  /// Distance of the nearest triangle; infinite beyond the reach.
  double distance(const geometry::Vec3& p) {
    if (cells_.empty()) fill();
    double least = std::numeric_limits<double>::infinity();
    const auto found = cells_.find(cell_of(p));
    if (found == cells_.end()) return least;
    for (const std::size_t i : found->second) {
      const Triangle& t = triangles_[i];
      least = std::min(least, distance_to_triangle(p, t[0], t[1], t[2]));
    }
    return least <= reach_ ? least : std::numeric_limits<double>::infinity();
  }

 private:
  using Triangle = std::array<geometry::Vec3, 3>;
  using Cell = std::array<std::int64_t, 3>;

  [[nodiscard]] Cell cell_of(const geometry::Vec3& p) const {
    const double edge = longest_ + reach_;
    const auto of = [&](double x) { return static_cast<std::int64_t>(std::floor(x / edge)); };
    return {of(p.x()), of(p.y()), of(p.z())};
  }
  void fill() {
    const geometry::Vec3 margin = geometry::Vec3::Constant(reach_);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = triangles_[i];
      const Cell low = cell_of(t[0].cwiseMin(t[1]).cwiseMin(t[2]) - margin);
      const Cell high = cell_of(t[0].cwiseMax(t[1]).cwiseMax(t[2]) + margin);
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
          for (std::int64_t z = low[2]; z <= high[2]; ++z) cells_[{x, y, z}].push_back(i);
        }
      }
    }
  }

  double reach_;
  double longest_ = 0.0;
  std::vector<Triangle> triangles_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

}  // namespace camway::testing
