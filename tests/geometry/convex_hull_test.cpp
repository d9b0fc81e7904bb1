// SPDX-License-Identifier: MIT
#include "daemon/geometry/convex_hull.h"

#include <map>
#include <set>

#include "daemon/geometry/triangle_intersection.h"
#include "tests/geometry/point_sets.h"

namespace camway::geometry {
namespace {

constexpr std::size_t kManyPoints = 512;  // as many as a body may have

using test::exact;
using test::exact_volume;
using test::PointSet;
using test::Rational;
using testing::Random;

Triangle triangle(const PointSet& set, const std::array<std::uint32_t, 3>& t) {
  return {set.points[t[0]], set.points[t[1]], set.points[t[2]]};
}

bool holds(const HalfSpace& face, const Vec3& point) {
  return dot(exact(face.normal), exact(point)) <= Rational(face.offset_m);
}

TEST(ConvexHull, IsAClosedSurfaceAboveWhichNoPointLies) {
  Random random(111);
  for (const PointSet& set : test::solid_point_sets(random)) {
    SCOPED_TRACE(set.what);
    const ConvexHull hull = convex_hull(set.points);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::set<std::uint32_t> corners;
    for (const auto& t : hull.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{t[k], t[(k + 1) % 3]}];
        corners.insert(t[k]);
      }
      const auto [a, b, c] = triangle(set, t);
      for (const Vec3& point : set.points) ASSERT_LE(exact_volume(a, b, c, point).sign(), 0);
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
    EXPECT_EQ(corners.size() + hull.triangles.size(), edges.size() / 2 + 2) << "Euler's formula";
  }
}

TEST(ConvexHull, FacesHoldEveryPointWithoutRounding) {
  Random random(112);
  for (const PointSet& set : test::solid_point_sets(random)) {
    SCOPED_TRACE(set.what);
    const ConvexHull hull = convex_hull(set.points);
    ASSERT_GE(hull.faces.size(), 4U);
    double size = 0.0;
    for (const Vec3& point : set.points) size = std::max(size, point.lpNorm<1>());
    for (const HalfSpace& face : hull.faces) {
      for (const Vec3& point : set.points) ASSERT_TRUE(holds(face, point));
      // Some points are on the face: 5 units for the scalar product, 5 that are added, one for the
      // sum here.
      double highest = -std::numeric_limits<double>::infinity();
      for (const Vec3& point : set.points) highest = std::max(highest, face.normal.dot(point));
      EXPECT_LE(face.offset_m - highest,
                11.0 * 0.5 * motion::test::kEpsilon * size + std::numeric_limits<double>::min());
    }
    // Means of points are inside, up to the rounding of the mean (one unit for each coordinate and
    // summand) and of the evaluation of the face.
    for (int i = 0; i < 50; ++i) {
      Vec3 mean = Vec3::Zero();
      double sum = 0.0;
      for (const Vec3& point : set.points) {
        const double weight = random.uniform(0.0, 1.0);
        mean += weight * point;
        sum += weight;
      }
      mean /= sum;
      const double rounding =
          (2.0 * static_cast<double>(set.points.size()) + 8.0) * motion::test::kEpsilon * size;
      for (const HalfSpace& face : hull.faces)
        ASSERT_LE(face.normal.dot(mean), face.offset_m + rounding);
    }
  }
}

TEST(ConvexHull, CountsEachFaceOnce) {
  PointSet set{"cube of a grid", {}};
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) set.points.emplace_back(x, y, z);
  EXPECT_EQ(convex_hull(set.points).faces.size(), 6U);
  set.points.emplace_back(1.5, 1.5, 4.0);
  EXPECT_EQ(convex_hull(set.points).faces.size(), 9U);
}

TEST(ConvexHull, OfAFlatSetCoversItOnce) {
  Random random(113);
  for (const PointSet& set : test::flat_point_sets(random)) {
    SCOPED_TRACE(set.what);
    const ConvexHull hull = convex_hull(set.points);
    EXPECT_TRUE(hull.faces.empty());
    for (const Vec3& point : set.points) {
      int touching = 0;
      for (const auto& t : hull.triangles)
        touching += geometry::triangles_touch(triangle(set, t), {point, point, point}) ? 1 : 0;
      ASSERT_GE(touching, 1);
    }
    // All points are corners of the polygon, and their triangles have the same orientation: it is
    // convex and without overlap.
    std::vector<std::uint32_t> corners{hull.triangles[0][0], hull.triangles[0][1]};
    for (const auto& t : hull.triangles) corners.push_back(t[2]);
    const auto normal = [&](std::size_t i) {
      const std::size_t n = corners.size();
      const test::RationalVec from = exact(set.points[corners[i % n]]);
      return cross(exact(set.points[corners[(i + 1) % n]]) - from,
                   exact(set.points[corners[(i + 2) % n]]) - from);
    };
    for (std::size_t i = 1; i < corners.size(); ++i) EXPECT_GT(dot(normal(0), normal(i)).sign(), 0);
  }
}

TEST(ConvexHull, OfPointsOnALineIsTheSegmentBetweenItsEnds) {
  const Vec3 direction(3, -5, 7);
  const std::vector<Vec3> points{2.0 * direction, 0.5 * direction, -4.0 * direction, direction,
                                 2.0 * direction};
  const ConvexHull hull = convex_hull(points);
  ASSERT_EQ(hull.triangles.size(), 1U);
  EXPECT_TRUE(hull.faces.empty());
  const auto& t = hull.triangles[0];
  EXPECT_EQ(t[1], t[2]);
  EXPECT_EQ(std::min(points[t[0]].x(), points[t[1]].x()), -12.0);
  EXPECT_EQ(std::max(points[t[0]].x(), points[t[1]].x()), 6.0);
}

TEST(ConvexHull, OfEqualPointsIsAPoint) {
  const std::vector<Vec3> points(7, Vec3(1, 2, 3));
  const ConvexHull hull = convex_hull(points);
  ASSERT_EQ(hull.triangles.size(), 1U);
  EXPECT_EQ(hull.triangles[0][0], hull.triangles[0][2]);
  EXPECT_TRUE(hull.faces.empty());
}

TEST(ConvexHull, OfAPyramidOnAManyCorneredBase) {
  std::vector<Vec3> points{Vec3(0, 0, 1)};
  // Points of a parabola in a tilted plane: all are corners, and exactly coplanar.
  for (int i = 1; i < static_cast<int>(kManyPoints); ++i)
    points.emplace_back(i, i * i, 3.0 * i + 7.0 * i * i);
  const ConvexHull hull = convex_hull(points);
  EXPECT_EQ(hull.triangles.size(), 2 * kManyPoints - 4);
  EXPECT_EQ(hull.faces.size(), kManyPoints);
}

}  // namespace
}  // namespace camway::geometry
