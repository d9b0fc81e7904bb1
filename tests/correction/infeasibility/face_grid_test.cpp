// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/face_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using geometry::Vec3;
using Number = boost::multiprecision::cpp_rational;
using Point = std::array<Number, 3>;
using Flat = std::array<Number, 2>;

Number area(const Flat& a, const Flat& b, const Flat& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Corners of a convex polygon, counter-clockwise, without those on its sides. It has fewer than
/// three if its inside is empty.
using Polygon = std::vector<Flat>;

/// Returns the convex hull (Andrew 1979).
Polygon hull_of(std::vector<Flat> points) {
  std::sort(points.begin(), points.end());
  Polygon hull;
  for (int way = 0; way < 2; ++way) {
    const std::size_t first = hull.size();
    for (const Flat& p : points) {
      while (hull.size() >= first + 2 && area(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Returns whether a point is in the polygon or on its border.
bool holds(const Polygon& polygon, const Flat& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (area(polygon[i], polygon[(i + 1) % polygon.size()], p) < 0) return false;
  }
  return polygon.size() >= 3;
}

/// Returns whether all of `other` is beyond a side of `one`, so that their insides do not meet.
bool has_beyond(const Polygon& one, const Polygon& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (std::all_of(other.begin(), other.end(), [&](const Flat& p) {
          return area(one[i], one[(i + 1) % one.size()], p) <= 0;
        })) {
      return true;
    }
  }
  return false;
}

bool are_apart(const Polygon& a, const Polygon& b) {
  return a.size() < 3 || has_beyond(a, b) || has_beyond(b, a);
}

/// A convex solid, and a plane across an axis.
struct GridCase {
  scene::Mesh mesh;
  std::vector<std::uint32_t> triangles;
  int axis = 0;
  double at = 0.0;
  Vec3 margin_m = Vec3::Zero();
  std::array<FaceGrid::Lines, 2> lines;

  /// Returns the corners of the section of plane and solid, whose vertices may move by the margin.
  [[nodiscard]] Polygon section(const std::vector<Vec3>& signs) const {
    std::vector<Point> corners;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      Point p;
      for (int k = 0; k < 3; ++k) {
        p[static_cast<std::size_t>(k)] =
            Number(mesh.vertices[i][k]) + Number(signs[i][k]) * Number(margin_m[k]);
      }
      corners.push_back(p);
    }
    const auto k = static_cast<std::size_t>(axis);
    const std::size_t u = (k + 1) % 3;
    const std::size_t v = (k + 2) % 3;
    std::vector<Flat> points;
    for (const Point& a : corners) {
      if (a[k] == Number(at)) points.push_back({a[u], a[v]});
      for (const Point& b : corners) {  // diagonals end inside, and do no harm
        if (!(a[k] < Number(at) && b[k] > Number(at))) continue;
        const Number f = (Number(at) - a[k]) / (b[k] - a[k]);
        points.push_back({a[u] + f * (b[u] - a[u]), a[v] + f * (b[v] - a[v])});
      }
    }
    return hull_of(std::move(points));
  }

  [[nodiscard]] Polygon cell(std::size_t u, std::size_t v) const {
    const Number a(lines[0][u]);
    const Number b(lines[0][u + 1]);
    const Number c(lines[1][v]);
    const Number d(lines[1][v + 1]);
    return {Flat{a, c}, Flat{b, c}, Flat{b, d}, Flat{a, d}};
  }
};

class RandomCases : public testing::Random {
 public:
  using Random::Random;

  bool one_of(int n) { return integer(1, n) == 1; }
  Vec3 vector() { return in_cube(1.0); }
  Vec3 signs() {
    Vec3 result;
    for (double& s : result) s = one_of(3) ? 0.0 : (one_of(2) ? 1.0 : -1.0);
    return result;
  }
  int axis() { return integer(0, 2); }

  /// Makes a tetrahedron, or a parallelepiped that may be parallel to the axes.
  GridCase solid() {
    GridCase c;
    const Vec3 place = one_of(3) ? Vec3(1e5 * vector()) : vector();
    if (one_of(2)) {
      for (int i = 0; i < 4; ++i) c.mesh.vertices.push_back(place + vector());
      c.mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    } else {
      testing::add_cuboid(c.mesh, Vec3(-0.3, -0.5, -0.8), Vec3(0.3, 0.5, 0.8));
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      if (!one_of(4)) turn = Eigen::AngleAxisd(uniform(0, 3), vector().normalized()).matrix();
      for (Vec3& vertex : c.mesh.vertices) vertex = turn * vertex + place;
    }
    c.triangles.resize(c.mesh.triangles.size());
    std::iota(c.triangles.begin(), c.triangles.end(), 0U);
    c.axis = axis();
    const Vec3& a = c.mesh.vertices[0];
    const Vec3& b = c.mesh.vertices.back();
    c.at = one_of(6) ? a[c.axis] : std::lerp(a[c.axis], b[c.axis], uniform(0.05, 0.95));
    if (one_of(2)) {
      for (double& m : c.margin_m) m = one_of(3) ? 0.0 : uniform(0.001, 0.03);
    }
    return c;
  }

  /// Adds grid lines, some within a few units of rounding of a point where an edge of the section
  /// crosses another line.
  void add_lines(GridCase& c) {
    const std::array<int, 2> axes = {(c.axis + 1) % 3, (c.axis + 2) % 3};
    geometry::Box box;
    for (const Vec3& vertex : c.mesh.vertices) box.extend(vertex);
    for (std::size_t k = 0; k < 2; ++k) {
      const double low = box.min()[axes[k]] - 0.1;
      const double high = box.max()[axes[k]] + 0.1;
      const int count = one_of(2) ? 4 : 14;
      for (int i = 0; i < count; ++i) c.lines[k].push_back(uniform(low, high));
    }
    const Vec3 zero = Vec3::Zero();
    const Polygon points = c.section(std::vector<Vec3>(c.mesh.vertices.size(), zero));
    const std::vector<double> rows = c.lines[1];
    for (int i = 0; i < 6 && points.size() > 2; ++i) {
      const auto any = [&] {
        return points[static_cast<std::size_t>(
            uniform(0, 0.999 * static_cast<double>(points.size())))];
      };
      const Flat a = any();
      const Flat b = any();
      const Number v(rows[static_cast<std::size_t>(i) % rows.size()]);
      if (a[1] == b[1]) continue;
      const Number x = a[0] + (b[0] - a[0]) * ((v - a[1]) / (b[1] - a[1]));
      double line = x.convert_to<double>();
      for (int step = integer(0, 3); step > 0; --step) {
        line = std::nextafter(line, one_of(2) ? 1e9 : -1e9);
      }
      if (std::abs(line - box.center()[axes[0]]) < 4.0) c.lines[0].push_back(line);
    }
    for (FaceGrid::Lines& lines : c.lines) {
      std::sort(lines.begin(), lines.end());
      lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    }
  }
};

// Cells near arbitrarily rotated solids, next to lines that edges meet up to a few roundings, and
// with uncertain vertices: exact arithmetic confirms every blocked cell.
TEST(FaceGrid, BlocksNothingBesideASolid) {
  RandomCases random(31);
  std::array<int, 2> blocked{};
  for (int trial = 0; trial < 150; ++trial) {
    GridCase c = random.solid();
    random.add_lines(c);
    const bool body_is_inside = random.one_of(3);
    FaceGrid grid(c.axis, c.at, c.lines, c.margin_m);
    grid.block(c.mesh, c.triangles, body_is_inside);
    const int draws = c.margin_m.isZero() ? 1 : 4;
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<Vec3> signs(c.mesh.vertices.size(), Vec3::Zero());
      if (draw > 0) std::generate(signs.begin(), signs.end(), [&] { return random.signs(); });
      const Polygon section = c.section(signs);
      for (std::size_t v = 0; v + 1 < c.lines[1].size(); ++v) {
        for (std::size_t u = 0; u + 1 < c.lines[0].size(); ++u) {
          if (!grid.is_blocked(u, v)) continue;
          ++blocked[body_is_inside ? 1 : 0];
          const Polygon cell = c.cell(u, v);
          if (body_is_inside) {
            ASSERT_TRUE(are_apart(section, cell)) << trial << " " << u << " " << v;
          } else {
            for (const Flat& p : cell)
              ASSERT_TRUE(holds(section, p)) << trial << " " << u << " " << v;
          }
        }
      }
    }
  }
  std::printf("%d and %d blocked cells\n", blocked[0], blocked[1]);
  EXPECT_GT(blocked[0], 1000);
  EXPECT_GT(blocked[1], 1000);
}

// One cell has a corner on a side of the section up to a few units of rounding and is otherwise
// inside. It may be blocked only if all of it is inside.
TEST(FaceGrid, RoundsToTheSafeSide) {
  RandomCases random(33);
  int blocked = 0;
  int cut = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    GridCase c = random.solid();
    c.margin_m = Vec3::Zero();
    const Polygon section = c.section(std::vector<Vec3>(c.mesh.vertices.size(), Vec3::Zero()));
    if (section.size() < 3) continue;
    const auto side =
        static_cast<std::size_t>(random.uniform(0, 0.999 * static_cast<double>(section.size())));
    const Flat& a = section[side];
    const Flat& b = section[(side + 1) % section.size()];
    const double ax = a[0].convert_to<double>();
    const double ay = a[1].convert_to<double>();
    const double v = std::lerp(ay, b[1].convert_to<double>(), random.uniform(0.3, 0.7));
    if (std::abs(b[1].convert_to<double>() - ay) < 0.1) continue;
    const Number x = a[0] + (b[0] - a[0]) * ((Number(v) - a[1]) / (b[1] - a[1]));
    double line = x.convert_to<double>();
    const double step = random.one_of(2) ? 1e9 : -1e9;
    for (int i = random.one_of(2) ? 1 : 0; i > 0; --i) line = std::nextafter(line, step);
    // Counter-clockwise: the inside is to the left of an upward side, and to the right of a
    // downward one.
    const double inward = b[1] > a[1] ? -1e-3 : 1e-3;
    const double recedes =
        (b[0].convert_to<double>() - ax) * inward * (b[1] > a[1] ? 1.0 : -1.0) > 0.0 ? -1e-3 : 1e-3;
    c.lines = {FaceGrid::Lines{std::min(line, line + inward), std::max(line, line + inward)},
               FaceGrid::Lines{std::min(v, v + recedes), std::max(v, v + recedes)}};
    FaceGrid grid(c.axis, c.at, c.lines);
    grid.block(c.mesh, c.triangles, false);
    const Polygon cell = c.cell(0, 0);
    const bool is_inside =
        std::all_of(cell.begin(), cell.end(), [&](const Flat& p) { return holds(section, p); });
    cut += is_inside ? 0 : 1;
    if (!grid.is_blocked(0, 0)) continue;
    ++blocked;
    ASSERT_TRUE(is_inside) << trial;
  }
  std::printf("%d blocked, %d cut\n", blocked, cut);
  EXPECT_GT(cut, 200);
}

// Returns triangles in the plane of the face that share edges, overlap, or occur twice.
GridCase flat_case(RandomCases& random) {
  GridCase c;
  c.axis = random.axis();
  c.at = random.uniform(-1, 1);
  const int count = static_cast<int>(random.uniform(1, 6));
  for (int i = 0; i < count; ++i) {
    std::array<Vec3, 3> corners;
    for (Vec3& p : corners) {
      p = random.vector();
      const bool is_shared = !c.mesh.vertices.empty() && random.one_of(2);
      if (is_shared) p = c.mesh.vertices[c.mesh.vertices.size() / 2];
      p[c.axis] = c.at;
    }
    testing::add_triangle(c.mesh, corners[0], corners[1], corners[2]);
    if (random.one_of(5)) testing::add_triangle(c.mesh, corners[1], corners[0], corners[2]);
  }
  for (std::uint32_t t = 0; t < c.mesh.triangles.size(); ++t) c.triangles.push_back(t);
  if (random.one_of(2)) {
    c.margin_m = Vec3::Constant(random.uniform(0.001, 0.02));
    c.margin_m[c.axis] = 0.0;
  }
  random.add_lines(c);
  return c;
}

// Each point of a blocked cell is on one of the triangles.
TEST(FaceGrid, BlocksNothingBesideFlatTriangles) {
  RandomCases random(32);
  int blocked = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const GridCase c = flat_case(random);
    FaceGrid grid(c.axis, c.at, c.lines, c.margin_m);
    grid.block_flat(c.mesh, c.mesh, c.triangles);
    const auto u_axis = (c.axis + 1) % 3;
    const auto v_axis = (c.axis + 2) % 3;
    // Vertices at the same place move together.
    std::vector<Vec3> signs(c.mesh.vertices.size(), Vec3::Zero());
    for (std::size_t i = 0; i < signs.size() && !c.margin_m.isZero(); ++i) {
      const auto same =
          std::find(c.mesh.vertices.begin(), c.mesh.vertices.end(), c.mesh.vertices[i]);
      const auto first = static_cast<std::size_t>(same - c.mesh.vertices.begin());
      signs[i] = first < i ? signs[first] : random.signs();
    }
    const auto corner = [&](std::size_t i) -> Flat {
      const auto moved = [&](int k) {
        return Number(c.mesh.vertices[i][k]) + Number(signs[i][k]) * Number(c.margin_m[k]);
      };
      return {moved(u_axis), moved(v_axis)};
    };
    const auto is_covered = [&](const Flat& p) {
      return std::any_of(c.mesh.triangles.begin(), c.mesh.triangles.end(), [&](const auto& t) {
        return holds(hull_of({corner(t[0]), corner(t[1]), corner(t[2])}), p);
      });
    };
    for (std::size_t v = 0; v + 1 < c.lines[1].size(); ++v) {
      for (std::size_t u = 0; u + 1 < c.lines[0].size(); ++u) {
        if (!grid.is_blocked(u, v)) continue;
        ++blocked;
        const Polygon cell = c.cell(u, v);
        for (const Flat& p : cell) ASSERT_TRUE(is_covered(p)) << trial << " " << u << " " << v;
        ASSERT_TRUE(is_covered({(cell[0][0] + cell[2][0]) / 2, (cell[0][1] + cell[2][1]) / 2}))
            << trial << " " << u << " " << v;
      }
    }
  }
  std::printf("%d blocked cells\n", blocked);
  EXPECT_GT(blocked, 500);
}

// Two triangles lie on the same side of their common edge, so it is no border of the area that is
// covered an odd number of times. The area beyond it must not count as covered twice.
TEST(FaceGrid, BlocksNothingBeyondAnEdgeOfTwoThatOverlap) {
  // The order in which parts of the grid are tested must not matter.
  for (const bool is_turned : {false, true}) {
    scene::Mesh mesh;
    const auto corner = [&](double u, double v) {
      return is_turned ? Vec3(1 - u, 1 - v, 0.0) : Vec3(u, v, 0.0);
    };
    testing::add_triangle(mesh, corner(0, 1), corner(1, 0), corner(0, 0));
    testing::add_triangle(mesh, corner(0, 1), corner(1, 0), corner(0.2, 0.2));
    FaceGrid::Lines lines;
    for (int i = 0; i <= 50; ++i) lines.push_back(i / 50.0);
    FaceGrid grid(2, 0.0, {lines, lines}, Vec3::Zero());
    grid.block_flat(mesh, mesh, std::vector<std::uint32_t>{0, 1});
    int blocked = 0;
    for (std::size_t v = 0; v < 50; ++v) {
      for (std::size_t u = 0; u < 50; ++u) {
        if (!grid.is_blocked(u, v)) continue;
        ++blocked;
        EXPECT_TRUE(is_turned ? u + v >= 49 : u + v <= 49) << u << " " << v;
      }
    }
    EXPECT_GT(blocked, 100);
  }
}

}  // namespace
}  // namespace camway::correction
