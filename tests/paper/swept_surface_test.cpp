// SPDX-License-Identifier: MIT
#include "daemon/paper/swept_surface.h"

#include <map>

#include "daemon/motion/path/bezier.h"
#include "tests/motion/random_motion.h"

namespace camway::paper {
namespace {

using motion::Corners;
using motion::Path;
using motion::Pose;
namespace bezier = motion::bezier;
namespace test = motion::test;
using test::kEpsilon;
using test::Vec3;
using testing::Random;

const Corners kCorners = motion::near_corners_C({1.5, 1.0, 0.2});

Path random_path(Random& random, int keyframes) {
  return interpolate(test::with_times(test::random_poses(random, keyframes)));
}

/// Returns the distance of `p` from a triangle by Ericson's regions (2005, section 5.1.5): the
/// nearest of the face, if `p` projects inside, and the three edges.
double distance_m(const Vec3& p, const geometry::Triangle& t) {
  double distance = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from = t[i];
    const Vec3 edge = t[(i + 1) % 3] - from;
    const double length2 = edge.squaredNorm();
    const double u = length2 > 0.0 ? std::clamp((p - from).dot(edge) / length2, 0.0, 1.0) : 0.0;
    distance = std::min(distance, (p - from - u * edge).norm());
  }
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  if (!(normal.squaredNorm() > 0.0)) return distance;
  for (std::size_t i = 0; i < 3; ++i) {
    if (normal.cross(t[(i + 1) % 3] - t[i]).dot(p - t[i]) < 0.0) return distance;
  }
  return std::min(distance, std::abs(normal.dot(p - t[0])) / normal.norm());
}

/// Returns the largest distance of the true ruled surfaces, densely sampled, from the two triangles
/// of each strip.
double sampled_error_m(const Path& path, const std::vector<SweptTriangle>& triangles) {
  double largest_m = 0.0;
  for (std::size_t i = 0; i + 1 < triangles.size(); i += 2) {
    const double t0_s = triangles[i].first_time_s();
    const double t1_s = triangles[i].last_time_s();
    const auto side = static_cast<std::size_t>(triangles[i].side);
    for (int k = 0; k <= 8; ++k) {
      const Corners corners = corners_W(kCorners, path.pose(bezier::lerp(t0_s, t1_s, k / 8.0)));
      for (int l = 0; l <= 8; ++l) {
        const Vec3 p = bezier::lerp(corners[side], corners[(side + 1) % 4], l / 8.0);
        largest_m = std::max(largest_m, std::min(distance_m(p, triangles[i].triangle()),
                                                 distance_m(p, triangles[i + 1].triangle())));
      }
    }
  }
  return largest_m;
}

TEST(SweptSurface, IsWithinTheChordErrorOfTheTrueSurface) {
  Random random(111);
  for (const double chord_error_m : {0.1, 0.02, 0.005, 0.001}) {
    const Path path = random_path(random, 5);
    const std::vector<SweptTriangle> triangles =
        tessellate_swept_surface(path, kCorners, chord_error_m, path.begin_s(), path.end_s());
    const double error_m = sampled_error_m(path, triangles);
    EXPECT_LE(error_m, chord_error_m);
    EXPECT_GE(error_m, 0.1 * chord_error_m) << "many more triangles than it takes";
  }
}

TEST(SweptSurface, StaysWithinTheErrorFarFromTheOrigin) {
  Random random(112);
  std::vector<Pose> poses = test::random_poses(random, 4);
  for (Pose& pose : poses) pose.position += Vec3(1e6, 1e6, -1e6);
  const Path path = interpolate(test::with_times(poses));
  const std::vector<SweptTriangle> triangles =
      tessellate_swept_surface(path, kCorners, 0.002, path.begin_s(), path.end_s());
  EXPECT_LE(sampled_error_m(path, triangles), 0.002);
}

TEST(SweptSurface, IsSortedAndItsParametersCoverTheInterval) {
  Random random(113);
  const Path path = random_path(random, 6);
  const double span_s = path.end_s() - path.begin_s();
  for (const auto& [from, to] :
       {std::pair{0.0, 1.0}, std::pair{0.13, 0.77}, std::pair{0.4, 0.41}}) {
    const double begin_s = path.begin_s() + from * span_s;
    const double end_s = from == 0.0 ? path.end_s() : path.begin_s() + to * span_s;
    const std::vector<SweptTriangle> triangles =
        tessellate_swept_surface(path, kCorners, 0.01, begin_s, end_s);
    ASSERT_FALSE(triangles.empty());
    ASSERT_EQ(triangles.size() % 8, 0U);
    double reached_s = begin_s;
    for (std::size_t i = 0; i < triangles.size(); i += 8) {
      for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_EQ(triangles[i + k].first_time_s(), reached_s) << "strips follow without a gap";
        EXPECT_EQ(triangles[i + k].last_time_s(), triangles[i].last_time_s());
        EXPECT_EQ(triangles[i + k].side, static_cast<int>(k / 2));
      }
      EXPECT_LT(reached_s, triangles[i].last_time_s());
      reached_s = triangles[i].last_time_s();
    }
    EXPECT_EQ(reached_s, end_s);
  }
}

TEST(SweptSurface, VerticesLieOnTheirCornerCurves) {
  Random random(114);
  const Path path = random_path(random, 6);
  for (const SweptTriangle& triangle : tessellate_swept_surface(path, kCorners, 0.01, 0.0, 1e9)) {
    for (const SweptVertex& vertex : triangle.vertices) {
      const Corners corners = corners_W(kCorners, path.pose(vertex.time_s));
      const auto side = static_cast<std::size_t>(triangle.side);
      const double off_m = std::min((vertex.position_W - corners[side]).norm(),
                                    (vertex.position_W - corners[(side + 1) % 4]).norm());
      EXPECT_LT(off_m, 1e3 * kEpsilon * 10.0) << "rounding of the time and of the pose";
    }
  }
}

// There are no cracks: every edge inside the tube belongs to two triangles, whose vertices have the
// same bits.
TEST(SweptSurface, IsClosedBetweenItsFirstAndLastQuadrilateral) {
  Random random(115);
  const Path path = random_path(random, 6);
  const std::vector<SweptTriangle> triangles =
      tessellate_swept_surface(path, kCorners, 0.01, path.begin_s(), path.end_s());
  using Point = std::array<double, 3>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto key = [](const Vec3& p) { return Point{p.x(), p.y(), p.z()}; };
  for (const SweptTriangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      Point a = key(triangle.vertices[i].position_W);
      Point b = key(triangle.vertices[(i + 1) % 3].position_W);
      if (b < a) std::swap(a, b);
      ++edges[{a, b}];
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_LE(count, 2);
    open += count == 1 ? 1 : 0;
  }
  EXPECT_EQ(open, 8) << "the four sides of the first and of the last quadrilateral";
}

TEST(SweptSurface, OfNothingIsEmpty) {
  Random random(116);
  const Path path = random_path(random, 3);
  EXPECT_TRUE(tessellate_swept_surface(path, kCorners, 0.01, 0.5, 0.5).empty());
  EXPECT_TRUE(tessellate_swept_surface(path, kCorners, 0.01, 0.7, 0.5).empty());
  EXPECT_TRUE(tessellate_swept_surface(path, kCorners, 0.01, 1e6, 2e6).empty());
}

TEST(SweptSurface, AStraightMoveIsOneStrip) {
  const Path path = interpolate(test::with_times(
      {{Vec3::Zero(), geometry::Quat::Identity()}, {Vec3(10, 2, 3), geometry::Quat::Identity()}}));
  EXPECT_EQ(tessellate_swept_surface(path, kCorners, 1e-6, 0.0, 1e9).size(), 8U);
}

TEST(SweptSurface, AnImpossibleErrorEndsWithinTheCap) {
  Random random(117);
  const Path path = random_path(random, 4);
  const std::vector<SweptTriangle> triangles =
      tessellate_swept_surface(path, kCorners, 1e-300, path.begin_s(), path.end_s());
  EXPECT_LE(triangles.size(), 8 * (kMaxSweptStrips + path.segments().size()));
  EXPECT_GE(triangles.size(), 8 * (kMaxSweptStrips / 8)) << "coarser than it needs to be";
}

TEST(SweptSurface, IsBitIdenticalWhenRepeated) {
  Random random(118);
  const Path path = random_path(random, 4);
  const auto a = tessellate_swept_surface(path, kCorners, 0.01, path.begin_s(), path.end_s());
  const auto b = tessellate_swept_surface(path, kCorners, 0.01, path.begin_s(), path.end_s());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(a[i].vertices[k].position_W, b[i].vertices[k].position_W);
      EXPECT_EQ(a[i].vertices[k].time_s, b[i].vertices[k].time_s);
    }
  }
}

}  // namespace
}  // namespace camway::paper
