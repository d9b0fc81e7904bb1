// SPDX-License-Identifier: MIT
#include "daemon/scene/field/surface_cells.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <vector>

#include "daemon/base/parallel_chunks.h"
#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Vec3;

constexpr std::size_t kTrianglesPerChunk = 1024;

std::size_t chunk_count(const Mesh& mesh) {
  return (mesh.triangles.size() + kTrianglesPerChunk - 1) / kTrianglesPerChunk;
}

/// Calls `visit(triangle)` for the triangles of a chunk, in order.
template <class Visit>
void visit_chunk(const Mesh& mesh, std::size_t chunk, const Visit& visit) {
  const std::size_t end = std::min(mesh.triangles.size(), (chunk + 1) * kTrianglesPerChunk);
  for (std::size_t i = chunk * kTrianglesPerChunk; i < end; ++i) visit(mesh.triangle(i));
}

/// A convex polygon. A triangle has three vertices, and either cut adds two at the most.
struct Polygon {
  std::array<Vec3, 7> vertices;
  std::size_t count = 0;

  void add(const Vec3& vertex) { vertices[count++] = vertex; }
};

struct Slab {
  int axis;
  double low;
  double high;
};

Vec3 crossing(const Vec3& a, const Vec3& b, int axis, double at) {
  return a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
}

/// The piece of the polygon between the two planes of the slab.
Polygon cut(const Polygon& polygon, const Slab& slab) {
  const auto [axis, low, high] = slab;
  Polygon result;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3& a = polygon.vertices[i];
    const Vec3& b = polygon.vertices[i + 1 == polygon.count ? 0 : i + 1];
    if (a[axis] >= low && a[axis] <= high) result.add(a);
    // An edge meets the planes in the order of its direction.
    if (a[axis] < b[axis]) {
      if (a[axis] < low && b[axis] >= low) result.add(crossing(a, b, axis, low));
      if (a[axis] <= high && b[axis] > high) result.add(crossing(a, b, axis, high));
    } else {
      if (a[axis] > high && b[axis] <= high) result.add(crossing(a, b, axis, high));
      if (a[axis] >= low && b[axis] < low) result.add(crossing(a, b, axis, low));
    }
  }
  return result;
}

class Marker {
 public:
  Marker(const CellGrid& grid, std::span<std::uint8_t> marks)
      : grid_(grid), margin_(mark_margin_cells(grid)), marks_(marks) {}

  void mark(const geometry::Triangle& triangle) const {
    Polygon whole;
    for (const Vec3& vertex : triangle) whole.add(grid_.in_cells(vertex));
    const Range z = range(whole, 2);
    for (std::int32_t k = z.first; k <= z.last; ++k) {
      if (z.first == z.last) {
        mark_slab(whole, k);
      } else {
        mark_slab(cut(whole, slab(2, k)), k);
      }
    }
  }

 private:
  struct Range {
    std::int32_t first;
    std::int32_t last;
  };

  [[nodiscard]] Slab slab(int axis, std::int32_t cell) const {
    return {axis, cell - margin_, cell + 1 + margin_};
  }

  /// The cells between the ends of the polygon; none if it is empty.
  [[nodiscard]] Range range(const Polygon& polygon, int axis) const {
    if (polygon.count == 0) return {0, -1};
    double low = polygon.vertices[0][axis];
    double high = low;
    for (std::size_t i = 1; i < polygon.count; ++i) {
      low = std::min(low, polygon.vertices[i][axis]);
      high = std::max(high, polygon.vertices[i][axis]);
    }
    const std::int32_t last = grid_.size[static_cast<std::size_t>(axis)] - 1;
    // The mesh keeps a quarter of a cell from the faces: truncating is rounding down.
    return {std::max(static_cast<std::int32_t>(low - margin_), 0),
            std::min(static_cast<std::int32_t>(high + margin_), last)};
  }

  void mark_slab(const Polygon& polygon, std::int32_t k) const {
    const Range y = range(polygon, 1);
    for (std::int32_t j = y.first; j <= y.last; ++j) {
      const Range x = y.first == y.last ? range(polygon, 0) : range(cut(polygon, slab(1, j)), 0);
      const std::size_t row =
          (static_cast<std::size_t>(k) * static_cast<std::size_t>(grid_.size[1]) +
           static_cast<std::size_t>(j)) *
          static_cast<std::size_t>(grid_.size[0]);
      for (std::int32_t i = x.first; i <= x.last; ++i) {
        // Several threads may set the same mark, all to the same value.
        std::atomic_ref<std::uint8_t>(marks_[row + static_cast<std::size_t>(i)])
            .store(1, std::memory_order_relaxed);
      }
    }
  }

  const CellGrid& grid_;
  const double margin_;
  const std::span<std::uint8_t> marks_;
};

}  // namespace

SurfaceExtent surface_extent(const Mesh& mesh, unsigned threads) {
  // One sum per chunk, added up in order, so that the rounding does not depend on the threads.
  std::vector<SurfaceExtent> sums(chunk_count(mesh));
  base::for_each_chunk(base::chunk_threads(threads), sums.size(), [&](unsigned, std::size_t chunk) {
    SurfaceExtent sum;
    visit_chunk(mesh, chunk, [&](const geometry::Triangle& t) {
      sum.area_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
      sum.outline_m += (t[1] - t[0]).norm() + (t[2] - t[1]).norm() + (t[0] - t[2]).norm();
      sum.triangles += 1.0;
    });
    sums[chunk] = sum;
  });
  SurfaceExtent total;
  for (const SurfaceExtent& sum : sums) {
    total.area_m2 += sum.area_m2;
    total.outline_m += sum.outline_m;
    total.triangles += sum.triangles;
  }
  return total;
}

// With u = 2^-53 and n cells on the longest side, let a point t of a triangle lie in a cell. The
// vertices in cells are off by 4u·n, so the computed triangle has a point within d0 = 4u·n of t in
// each coordinate; it is in the slab of t's cell if the slab is extended by d0. A crossing is a
// point of the edge up to d1 = 7u·n: the fraction is off by 3u, its product with the edge by 2u
// more, the sum by u·n, all times at most n. So the computed polygon after one cut has a point
// within d0 + d1 of t, in the row if the row is extended as much, and after two cuts within d0 +
// 2·d1 = 18u·n. The sums with the margin round by 2u·n.
double mark_margin_cells(const CellGrid& grid) {
  return 20.0 * geometry::kUnitRoundoff * grid.longest_side() + reliable_margin_cells(grid);
}

double reliable_margin_cells(const CellGrid& grid) { return 3.0 * grid.coordinate_error_cells(); }

void mark_touched_cells(const Mesh& mesh, const CellGrid& grid, unsigned threads,
                        std::span<std::uint8_t> marks) {
  assert(marks.size() == grid.cells());
  const Marker marker(grid, marks);
  base::for_each_chunk(
      base::chunk_threads(threads), chunk_count(mesh), [&](unsigned, std::size_t chunk) {
        visit_chunk(mesh, chunk, [&](const geometry::Triangle& t) { marker.mark(t); });
      });
}

}  // namespace camway::scene
