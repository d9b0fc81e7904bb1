// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/polygon_cutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/scene/import/readers/mesh_files.h"

namespace camway::scene::mesh_readers {
namespace {

using testing::Random;

/// Lattice points with coordinates up to 100, so that every product is exact in 64 bits.
using Lattice = std::array<std::int64_t, 2>;

std::int64_t turn(const Lattice& a, const Lattice& b, const Lattice& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

int sign(std::int64_t x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

bool is_on(const Lattice& p, const Lattice& a, const Lattice& b) {
  return turn(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool segments_meet(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d) {
  const bool cross = sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
                     sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
  return cross || is_on(c, a, b) || is_on(d, a, b) || is_on(a, c, d) || is_on(b, c, d);
}

/// Returns whether the edges from corner `at - 1` to a new corner at `p`, and from there to corner
/// `at`, meet the outline at their ends only.
bool fits(const std::vector<Lattice>& outline, std::size_t at, const Lattice& p) {
  const std::size_t count = outline.size();
  const Lattice& a = outline[(at + count - 1) % count];
  const Lattice& b = outline[at % count];
  if (p == a || p == b) return false;
  if (is_on(a, p, b) || is_on(b, a, p)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const Lattice& c = outline[i];
    const Lattice& d = outline[(i + 1) % count];
    if (c == a && d == b) continue;
    if (is_on(p, c, d)) return false;
    if (d == a ? is_on(c, a, p) : segments_meet(a, p, c, d)) return false;
    if (c == b ? is_on(d, p, b) : segments_meet(p, b, c, d)) return false;
  }
  return true;
}

/// Returns a random outline without self-intersections, grown from a triangle corner by corner.
/// Some corners are on the line between their neighbours.
std::vector<Lattice> random_outline(Random& random, std::size_t corners) {
  const auto any = [&] {
    return Lattice{static_cast<std::int64_t>(testing::below(random, 41)),
                   static_cast<std::int64_t>(testing::below(random, 41))};
  };
  std::vector<Lattice> outline;
  while (outline.empty()) {
    const Lattice a = any();
    const Lattice b = any();
    const Lattice c = any();
    if (turn(a, b, c) != 0) outline = {a, b, c};
  }
  for (int tries = 0; tries < 20'000 && outline.size() < corners; ++tries) {
    const std::size_t at = 1 + testing::below(random, outline.size());
    const Lattice p = any();
    if (fits(outline, at, p)) outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(at), p);
  }
  return outline;
}

std::int64_t doubled_area(const std::vector<Lattice>& outline) {
  std::int64_t sum = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    sum += turn(outline[0], outline[i], outline[i + 1]);
  }
  return sum;
}

/// Maps a lattice point onto a plane in space, which may be nearly vertical, without rounding.
Point in_space(const Lattice& p, int plane) {
  const auto x = static_cast<double>(p[0]);
  const auto y = static_cast<double>(p[1]);
  switch (plane) {
    case 0:
      return {x, y, 0.25};
    case 1:
      return {y + 1e6, 3.0, x};
    case 2:
      return {-7.0, x * 0.125, 1e6 + y * 0.125};
    case 3:
      return {x + y, x - y, 0.001953125 * x};
    default:
      return {x + 2.0 * y, 5.0 * x - y, 64.0 * x + 3.0 * y};
  }
}

bool covers(const std::array<Lattice, 3>& triangle, const Lattice& p) {
  return turn(triangle[0], triangle[1], p) > 0 && turn(triangle[1], triangle[2], p) > 0 &&
         turn(triangle[2], triangle[0], p) > 0;
}

bool touches(const std::array<Lattice, 3>& triangle, const Lattice& p) {
  return turn(triangle[0], triangle[1], p) >= 0 && turn(triangle[1], triangle[2], p) >= 0 &&
         turn(triangle[2], triangle[0], p) >= 0;
}

/// Expects that all triangles have the outline's orientation, that none overlaps another, and that
/// together they have its area: then they are exactly its inside.
void expect_cover(const std::vector<Lattice>& outline, int plane) {
  std::vector<Point> corners;
  for (const Lattice& p : outline) corners.push_back(in_space(p, plane));
  PolygonCutter cutter;
  const auto cuts = cutter.cut(corners);
  ASSERT_EQ(cuts.size(), outline.size() - 2);
  const std::int64_t whole = doubled_area(outline);
  std::int64_t sum = 0;
  std::vector<std::array<Lattice, 3>> triangles;
  for (const PolygonCutter::Cut& cut : cuts) {
    std::array<Lattice, 3> t = {outline[cut[0]], outline[cut[1]], outline[cut[2]]};
    const std::int64_t area = turn(t[0], t[1], t[2]);
    ASSERT_GE(area * sign(whole), 0);
    sum += area;
    if (area < 0) std::swap(t[1], t[2]);
    if (area != 0) triangles.push_back(t);
  }
  ASSERT_EQ(sum, whole);
  for (std::int64_t x = 0; x <= 40; ++x) {
    for (std::int64_t y = 0; y <= 40; ++y) {
      int within = 0;
      int at = 0;
      for (const auto& t : triangles) {
        within += covers(t, {x, y}) ? 1 : 0;
        at += touches(t, {x, y}) ? 1 : 0;
      }
      ASSERT_LE(within, 1);
      ASSERT_FALSE(within == 1 && at > 1);
    }
  }
}

TEST(PolygonCutter, CoversAnyOutlineExactly) {
  Random random(testing::kMeshSeed);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    std::vector<Lattice> outline = random_outline(random, 4 + testing::below(random, 30));
    if (outline.size() < 4) continue;
    if (trial % 2 == 0) std::reverse(outline.begin(), outline.end());
    expect_cover(outline, trial % 5);
    if (HasFatalFailure()) return;
  }
}

TEST(PolygonCutter, CutsQuadrilateralsAtTheirReflexCorner) {
  // An arrow head, beginning at each of its corners in turn.
  std::vector<Lattice> arrow = {{0, 0}, {20, 10}, {0, 20}, {10, 10}};
  for (int begin = 0; begin < 4; ++begin) {
    for (int plane = 0; plane < 5; ++plane) {
      expect_cover(arrow, plane);
      if (HasFatalFailure()) return;
    }
    std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
  }
}

TEST(PolygonCutter, CutsAroundAHoleWithASeam) {
  // A square with a square hole, connected by a line in both directions.
  expect_cover({{0, 0},
                {40, 0},
                {40, 40},
                {0, 40},
                {0, 0},
                {10, 10},
                {10, 30},
                {30, 30},
                {30, 10},
                {10, 10}},
               0);
}

bool is_inside(const std::vector<Lattice>& outline, const Lattice& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Lattice& a = outline[i];
    const Lattice& b = outline[(i + 1) % outline.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) && (turn(a, b, p) > 0) == (b[1] > a[1])) inside = !inside;
  }
  return inside;
}

bool outlines_meet(const std::vector<Lattice>& a, const std::vector<Lattice>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (segments_meet(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()])) return true;
    }
  }
  return false;
}

/// Returns an outline, ten times as large as the others, with holes inside that do not meet it or
/// each other.
std::vector<std::vector<Lattice>> random_outlines(Random& random) {
  std::vector<std::vector<Lattice>> outlines = {
      random_outline(random, 3 + testing::below(random, 20))};
  for (Lattice& p : outlines[0]) p = {10 * p[0], 10 * p[1]};
  for (int tries = 0; tries < 40; ++tries) {
    std::vector<Lattice> hole = random_outline(random, 3 + testing::below(random, 8));
    const auto dx = static_cast<std::int64_t>(testing::below(random, 360));
    const auto dy = static_cast<std::int64_t>(testing::below(random, 360));
    for (Lattice& p : hole) p = {p[0] + dx, p[1] + dy};
    bool fits = is_inside(outlines[0], hole[0]);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      fits = fits && !outlines_meet(outlines[i], hole);
      fits = fits &&
             (i == 0 || (!is_inside(outlines[i], hole[0]) && !is_inside(hole, outlines[i][0])));
    }
    if (fits) outlines.push_back(hole);
  }
  return outlines;
}

/// Expects triangles of the orientation and the area of the outline without its holes, none of
/// which has an inner lattice point outside.
void expect_cover(const std::vector<std::vector<Lattice>>& outlines, int plane) {
  std::vector<Lattice> lattice;
  std::vector<Point> corners;
  std::vector<std::size_t> ends;
  std::int64_t whole = 0;
  for (const std::vector<Lattice>& outline : outlines) {
    for (const Lattice& p : outline) lattice.push_back(p), corners.push_back(in_space(p, plane));
    const std::int64_t area = std::abs(doubled_area(outline));
    whole += ends.empty() ? area : -area;
    ends.push_back(corners.size());
  }
  PolygonCutter cutter;
  const auto cuts = cutter.cut(corners, ends);
  ASSERT_EQ(cuts.size(), corners.size() + 2 * (ends.size() - 1) - 2);
  const int side = sign(doubled_area(outlines[0]));
  std::int64_t sum = 0;
  for (const PolygonCutter::Cut& cut : cuts) {
    const std::int64_t area = side * turn(lattice[cut[0]], lattice[cut[1]], lattice[cut[2]]);
    ASSERT_GE(area, 0);
    sum += area;
    // Three times the centre of the triangle, in a lattice three times as fine.
    Lattice centre{};
    for (std::size_t k = 0; k < 2; ++k) {
      centre[k] = lattice[cut[0]][k] + lattice[cut[1]][k] + lattice[cut[2]][k];
    }
    if (area == 0) continue;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      std::vector<Lattice> fine = outlines[i];
      for (Lattice& p : fine) p = {3 * p[0], 3 * p[1]};
      ASSERT_EQ(is_inside(fine, centre), i == 0);
    }
  }
  ASSERT_EQ(sum, whole);
}

TEST(PolygonCutter, CutsHolesOutOfAnyOutline) {
  Random random(testing::kMeshSeed);
  std::size_t holes = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    std::vector<std::vector<Lattice>> outlines = random_outlines(random);
    for (std::vector<Lattice>& outline : outlines) {
      if (testing::below(random, 2) == 0) std::reverse(outline.begin(), outline.end());
    }
    holes += outlines.size() - 1;
    if (outlines.size() > 1) expect_cover(outlines, trial % 5);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(holes, 1000U);
}

TEST(PolygonCutter, ReachesHolesThatTouchNothingButLieInALine) {
  // Bridges would run through the corners of other holes.
  std::vector<std::vector<Lattice>> outlines = {{{0, 0}, {400, 0}, {400, 400}, {0, 400}}};
  for (std::int64_t i = 1; i < 19; ++i) {
    for (std::int64_t j = 1; j < 19; j += 3) {
      outlines.push_back({{20 * i, 20 * j}, {20 * i + 10, 20 * j}, {20 * i, 20 * j + 10}});
    }
  }
  for (int plane = 0; plane < 5; ++plane) {
    expect_cover(outlines, plane);
    if (HasFatalFailure()) return;
  }
}

TEST(PolygonCutter, SaysWhenAHoleCannotBeReached) {
  PolygonCutter cutter;
  const std::vector<std::size_t> ends = {4, 7};
  const std::vector<Point> square = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  const std::vector<std::vector<Point>> holes = {
      {{5, 1, 0}, {6, 1, 0}, {6, 2, 0}},  // outside
      {{1, 1, 0}, {2, 1, 0}, {3, 1, 0}},  // without area
      {{1, 1, 0}, {1, 1, 0}, {2, 1, 0}},
  };
  for (const std::vector<Point>& hole : holes) {
    std::vector<Point> corners = square;
    corners.insert(corners.end(), hole.begin(), hole.end());
    EXPECT_TRUE(cutter.cut(corners, ends).empty());
  }
}

TEST(PolygonCutter, LeavesNothingOutWhereThereIsNoInside) {
  PolygonCutter cutter;
  // A star drawn in one line, a segment in both directions, one point five times.
  EXPECT_EQ(
      cutter.cut(std::vector<Point>{{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}})
          .size(),
      3U);
  EXPECT_EQ(
      cutter.cut(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3, 0, 0}}).size(),
      3U);
  EXPECT_EQ(cutter.cut(std::vector<Point>(5, Point{1, 1, 1})).size(), 3U);
}

TEST(PolygonCutter, CutsConvexPolygonsOfManyCornersInLinearTime) {
  constexpr int kCorners = 100'000;
  std::vector<Point> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::acos(-1.0) * i / kCorners;
    corners.push_back({1e6 + std::cos(angle), std::sin(angle), 2.0});
  }
  PolygonCutter cutter;
  EXPECT_EQ(cutter.cut(corners).size(), std::size_t{kCorners - 2});
}

TEST(Orientation, IsExactWhereDoublesAreNot) {
  // Points on the line y = x, one off by the last bit, in either order.
  const double step = 0x1p-53;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.5 + step * 2 * i;
    EXPECT_EQ(orientation({x, x}, {12.0, 12.0}, {24.0, 24.0}), 0.0);
    EXPECT_GT(orientation({x, x + 2 * step}, {12.0, 12.0}, {24.0, 24.0}), 0.0) << i;
    EXPECT_LT(orientation({12.0, 12.0}, {x, x + 2 * step}, {24.0, 24.0}), 0.0) << i;
  }
}

}  // namespace
}  // namespace camway::scene::mesh_readers
