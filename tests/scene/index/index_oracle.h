// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "daemon/geometry/segment_triangle.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/index/scene_index.h"
#include "tests/geometry/random_triangles.h"

/// The oracle of the queries: tests every triangle.
namespace camway::scene {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline std::optional<std::uint32_t> brute_first_intersection(const SceneIndex& tree,
                                                             const geometry::Triangle& t) {
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    if (geometry::triangles_touch(t, tree.triangle(i))) return i;
  }
  return std::nullopt;
}

inline std::optional<SegmentHit> brute_closest_hit(const SceneIndex& tree,
                                                   const geometry::LineSegment& segment) {
  std::optional<SegmentHit> best;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const auto fraction = geometry::hit_fraction(segment, tree.triangle(i));
    if (fraction && (!best || *fraction < best->fraction)) best = SegmentHit{*fraction, i};
  }
  return best;
}

inline std::optional<Nearest> brute_nearest(const SceneIndex& tree,
                                            std::span<const geometry::Triangle> body,
                                            double cutoff_m) {
  std::optional<Nearest> best;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    for (const geometry::Triangle& part : body) {
      const double distance_m = geometry::triangle_distance(part, tree.triangle(i));
      if (distance_m < (best ? best->distance_m : cutoff_m)) best = Nearest{distance_m, i};
    }
  }
  return best;
}

inline void expect_equal(const std::optional<SegmentHit>& a, const std::optional<SegmentHit>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->fraction, b->fraction);
  EXPECT_EQ(a->triangle, b->triangle);
}

inline void expect_equal(const std::optional<Nearest>& a, const std::optional<Nearest>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->distance_m, b->distance_m);
  EXPECT_EQ(a->triangle, b->triangle);
}

/// Returns triangles of all sizes in a cube of 10 m, with many small ones in one corner.
inline std::vector<geometry::Triangle> soup(geometry::RandomTriangles& random, int count) {
  std::vector<geometry::Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const double size = random.log_uniform(1e-3, 3.0);
    const geometry::Vec3 center = random.in_cube(i % 2 == 0 ? 5.0 : 0.3);
    triangles.push_back({center + random.in_cube(size), center + random.in_cube(size),
                         center + random.in_cube(size)});
  }
  return triangles;
}

/// Returns triangles with integer coordinates: touching, coplanar, equal and degenerate ones, and
/// ties in distance.
inline std::vector<geometry::Triangle> grid_soup(geometry::RandomTriangles& random, int count) {
  std::vector<geometry::Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const geometry::Vec3 at = random.on_grid(12);
    triangles.push_back(geometry::moved(random.grid_triangle(2), at));
    if (i % 5 == 0) triangles.push_back(triangles.back());
  }
  return triangles;
}

}  // namespace camway::scene
