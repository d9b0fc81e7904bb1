// SPDX-License-Identifier: MIT
#include "daemon/motion/body/body.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <numbers>

#include "tests/geometry/point_sets.h"

namespace camway::motion {
namespace {

using geometry::Triangle;
using geometry::test::exact;
using geometry::test::Rational;
using test::Vec3;
using testing::Random;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Camera kCamera{1.5, 1.0, 0.2};
constexpr double kScaling = 1e-12;  // rounding of a few products and sums, with room

Body made(const BodyShape& shape) {
  const base::Result<Body> body = Body::make(shape);
  EXPECT_TRUE(body) << body.error;
  return body ? *body : Body(kCamera);
}

/// Sorts triangles and their vertices, so that lists can be compared.
std::vector<std::array<double, 9>> sorted(std::span<const Triangle> triangles) {
  std::vector<std::array<double, 9>> list;
  for (const Triangle& t : triangles) {
    std::array<double, 9> least{};
    least.fill(std::numeric_limits<double>::infinity());
    for (std::size_t first = 0; first < 3; ++first) {
      std::array<double, 9> turned{};
      for (std::size_t k = 0; k < 9; ++k)
        turned[k] = t[(first + k / 3) % 3][static_cast<Eigen::Index>(k % 3)];
      least = std::min(least, turned);
    }
    list.push_back(least);
  }
  std::sort(list.begin(), list.end());
  return list;
}

double signed_volume(std::span<const Triangle> triangles) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) sum += a.dot(b.cross(c)) / 6.0;
  return sum;
}

BoxShape random_box(Random& random) {
  const auto size = [&] { return random.log_uniform(1e-3, 10.0); };
  return {random.normal_vector(2.0), {size(), size(), size()}};
}

std::vector<Vec3> corners(const BoxShape& box) {
  std::vector<Vec3> points;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        points.push_back(box.center_C + Vec3(x, y, z).cwiseProduct(box.size_m));
  return points;
}

TEST(Body, OfACameraIsItsNearQuadrilateral) {
  const Body body(kCamera);
  const Corners c = near_corners_C(kCamera);
  ASSERT_EQ(body.triangles_C().size(), 2U);
  EXPECT_EQ(body.triangles_C()[0], (Triangle{c[0], c[1], c[2]}));
  EXPECT_EQ(body.triangles_C()[1], (Triangle{c[0], c[2], c[3]}));
  EXPECT_EQ(body.ball_radius_m(), 0.0);
  EXPECT_TRUE(body.solids_C().empty());
  EXPECT_GE(body.radius_m(), body_radius_m(c));
  EXPECT_LE(body.radius_m(), body_radius_m(c) * (1.0 + 16.0 * test::kEpsilon));
  EXPECT_EQ(sorted(made(kCamera).triangles_C()), sorted(body.triangles_C()));
}

TEST(Body, OfABoxIsClosedTurnsOutwardAndHasItsVolume) {
  Random random(121);
  for (int i = 0; i < 200; ++i) {
    const BoxShape box = random_box(random);
    const Body body = made(box);
    ASSERT_EQ(body.triangles_C().size(), 12U);
    ASSERT_EQ(body.solids_C().size(), 1U);
    ASSERT_EQ(body.solids_C()[0].faces_C.size(), 6U);
    // Rounding of corners, and of a volume about the origin: relative to the cube of the radius.
    EXPECT_NEAR(signed_volume(body.triangles_C()), box.size_m.prod(),
                64.0 * test::kEpsilon * std::pow(body.radius_m(), 3));
    for (const Vec3& corner : corners(box)) EXPECT_LE(corner.norm(), body.radius_m());
    // The true box, not the rounded one, satisfies the half-spaces.
    for (const geometry::HalfSpace& face : body.solids_C()[0].faces_C) {
      Eigen::Index axis = 0;
      face.normal.cwiseAbs().maxCoeff(&axis);
      const Rational sign(face.normal[axis]);
      EXPECT_LE(Rational(sign * Rational(box.center_C[axis]) + Rational(box.size_m[axis]) / 2),
                Rational(face.offset_m));
    }
  }
}

TEST(Body, OfABoxIsTheHullOfItsCornersAndTheMeshOfItsTriangles) {
  Random random(122);
  for (int i = 0; i < 50; ++i) {
    const BoxShape box = random_box(random);
    const Body body = made(box);
    MeshShape mesh;
    std::map<std::array<double, 3>, std::uint32_t> known;
    for (const Triangle& t : body.triangles_C()) {
      mesh.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [place, is_new] = known.try_emplace({t[k].x(), t[k].y(), t[k].z()},
                                                       static_cast<std::uint32_t>(known.size()));
        if (is_new) mesh.vertices_C.push_back(t[k]);
        mesh.triangles.back()[k] = place->second;
      }
    }
    ASSERT_EQ(mesh.vertices_C.size(), 8U);
    const Body as_mesh = made(mesh);
    EXPECT_EQ(sorted(as_mesh.triangles_C()), sorted(body.triangles_C()));
    EXPECT_TRUE(as_mesh.solids_C().empty());

    const Body as_hull = made(ConvexShape{{corners(box)}});
    EXPECT_EQ(as_hull.triangles_C().size(), 12U);
    ASSERT_EQ(as_hull.solids_C().size(), 1U);
    EXPECT_EQ(as_hull.slack_m(), 0.0);
    EXPECT_EQ(as_hull.radius_m(), body.radius_m());
    EXPECT_NEAR(signed_volume(as_hull.triangles_C()), signed_volume(body.triangles_C()),
                64.0 * test::kEpsilon * std::pow(body.radius_m(), 3));
    for (const geometry::HalfSpace& face : body.solids_C()[0].faces_C) {
      const auto same = [&](const geometry::HalfSpace& other) {
        return (other.normal - face.normal).norm() < 1e-12 &&
               std::abs(other.offset_m - face.offset_m) < 1e-12;
      };
      EXPECT_TRUE(std::ranges::any_of(as_hull.solids_C()[0].faces_C, same));
    }
  }
}

TEST(Body, SlackCoversTheRoundingOfCorners) {
  Random random(123);
  for (int i = 0; i < 300; ++i) {
    const BoxShape box{random.normal_vector(random.log_uniform(1e-3, 1e6)),
                       Vec3::Constant(random.log_uniform(1e-9, 1.0))};
    const Body body = made(box);
    // Expected lower and upper corner, compared with the half-spaces' own corners.
    for (const Triangle& t : body.triangles_C()) {
      for (const Vec3& vertex : t) {
        Rational square = 0;
        for (Eigen::Index k = 0; k < 3; ++k) {
          const Rational half = Rational(box.size_m[k]) / 2;
          const Rational center(box.center_C[k]);
          const Rational low = Rational(vertex[k]) - (center - half);
          const Rational high = Rational(vertex[k]) - (center + half);
          const Rational off = abs(low) < abs(high) ? low : high;
          square += off * off;
        }
        ASSERT_LE(square, Rational(body.slack_m()) * Rational(body.slack_m()));
      }
    }
    EXPECT_LE(body.slack_m(), 1e-15 * body.radius_m() + 1e-300);
  }
}

TEST(Body, OfASphereIsAPointAndABall) {
  const Body body = made(SphereShape{{1, 2, 2}, 0.5});
  ASSERT_EQ(body.triangles_C().size(), 1U);
  for (const Vec3& vertex : body.triangles_C()[0]) EXPECT_EQ(vertex, Vec3(1, 2, 2));
  EXPECT_EQ(body.ball_radius_m(), 0.5);
  EXPECT_TRUE(body.solids_C().empty());
  EXPECT_GE(body.radius_m(), 3.0);
  EXPECT_LE(body.radius_m(), 3.0 + 1e-14);
  EXPECT_EQ(made(SphereShape{Vec3::Zero(), 0.5}).radius_m(), 0.0) << "turning moves no point";
}

TEST(Body, OfPiecesHasASolidForEachWithVolume) {
  Random random(124);
  ConvexShape shape;
  for (const int count : {1, 2, 3, 4, 20}) {
    shape.pieces_C.emplace_back();
    for (int i = 0; i < count; ++i) shape.pieces_C.back().push_back(random.normal_vector(1.0));
  }
  const Body body = made(shape);
  EXPECT_EQ(body.solids_C().size(), 2U);
  EXPECT_EQ(body.slack_m(), 0.0);
  double farthest = 0.0;
  for (const auto& piece : shape.pieces_C)
    for (const Vec3& point : piece) farthest = std::max(farthest, point.norm());
  EXPECT_LE(body.radius_m(), farthest * (1.0 + 1e-14));
}

TEST(Body, LengthsNeitherOverflowNorVanish) {
  EXPECT_GE(made(SphereShape{{1e-300, 0, 0}, 1.0}).radius_m(), 1e-300);
  EXPECT_GE(made(ConvexShape{{{{1e9, 1e9, 1e9}, {0, 0, 0}}}}).radius_m(),
            1e9 * std::numbers::sqrt3);
  EXPECT_GT(made(SphereShape{{5e-324, 0, 0}, 1.0}).radius_m(), 0.0);
}

TEST(Body, ScalesAboutAPoint) {
  constexpr double kFactor = 0.25;
  const Vec3 about(0.5, -1.0, 2.0);
  const auto moved = [&](const Vec3& point) { return Vec3(about + kFactor * (point - about)); };
  const BoxShape box{Vec3(1, 2, 3), Vec3(0.5, 1, 2)};
  const Body scaled = made(box).scaled(about, kFactor);
  const Body small = made(BoxShape{moved(box.center_C), kFactor * box.size_m});
  ASSERT_EQ(scaled.triangles_C().size(), small.triangles_C().size());
  for (std::size_t i = 0; i < small.triangles_C().size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(scaled.triangles_C()[i][k].isApprox(small.triangles_C()[i][k])) << i;
    }
  }
  EXPECT_TRUE(scaled.center_C().isApprox(small.center_C()));
  EXPECT_NEAR(scaled.radius_m(), small.radius_m(), kScaling * small.radius_m());
  EXPECT_TRUE(scaled.is_near(moved(box.center_C), 0.0)) << "its solid is scaled, too";
  EXPECT_FALSE(scaled.is_near(box.center_C, 0.0));
  EXPECT_EQ(made(SphereShape{about, 2.0}).scaled(about, kFactor).ball_radius_m(), 0.5);
}

TEST(Body, IsNearWhatIsInsideOrBeside) {
  const Body box = made(BoxShape{Vec3::Zero(), Vec3(2, 2, 2)});
  EXPECT_TRUE(box.is_near(Vec3::Zero(), 0.0));
  EXPECT_TRUE(box.is_near(Vec3(1.25, 0, 0), 0.25));
  EXPECT_FALSE(box.is_near(Vec3(1.25, 0, 0), 0.125));
  const Body ball = made(SphereShape{Vec3::Zero(), 1.0});
  EXPECT_TRUE(ball.is_near(Vec3(0, 1.25, 0), 0.25));
  EXPECT_FALSE(ball.is_near(Vec3(0, 1.25, 0), 0.125));
  // A surface is only near itself, a solid mesh also to its inside.
  MeshShape tetrahedron{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  EXPECT_FALSE(made(tetrahedron).is_near(Vec3(0.5, 0.5, 0.5), 0.25));
  tetrahedron.solid = true;
  EXPECT_TRUE(made(tetrahedron).is_near(Vec3(0.5, 0.5, 0.5), 0.25));
}

TEST(Body, NamesItsFeatures) {
  const Body camera(kCamera);
  EXPECT_EQ(camera.feature_name(0), "inside");
  EXPECT_EQ(camera.feature_name(1), "edge 0");
  EXPECT_EQ(camera.feature_name(4), "edge 3");
  EXPECT_EQ(camera.feature_name(5), "corner 0");
  EXPECT_EQ(camera.feature_name(8), "corner 3");
  EXPECT_EQ(made(SphereShape{Vec3::Zero(), 1.0}).feature_name(0), "surface");
  EXPECT_EQ(made(BoxShape{Vec3::Zero(), Vec3::Ones()}).feature_name(7), "face 7");
}

TEST(Body, RefusesShapesAndNamesTheFieldAtFault) {
  const BoxShape box{Vec3::Zero(), Vec3::Ones()};
  const ConvexShape two{{{Vec3::Zero()}, {Vec3::Ones()}}};
  const MeshShape mesh{{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, {{0, 1, 2}}};
  const auto edited = [](auto shape, const auto& edit) {
    edit(shape);
    return BodyShape(shape);
  };
  const std::pair<std::string, BodyShape> cases[] = {
      {"size[1]: is -1 m; it must be above 0 and at most 1e+09 m",
       edited(box, [](auto& b) { b.size_m.y() = -1.0; })},
      {"size[2]: is 0 m", edited(box, [](auto& b) { b.size_m.z() = 0.0; })},
      {"size[0]: is nan m", edited(box, [](auto& b) { b.size_m.x() = kNaN; })},
      {"size[0]: is 2000000000 m", edited(box, [](auto& b) { b.size_m.x() = 2e9; })},
      {"center: is not finite", edited(box, [](auto& b) { b.center_C.x() = kNaN; })},
      {"center: is more than 1e+09 m from the eye",
       edited(box, [](auto& b) { b.center_C.x() = -2e9; })},
      {"radius_m: is 0 m", SphereShape{Vec3::Zero(), 0.0}},
      {"center: is not finite", SphereShape{{0, kNaN, 0}, 1.0}},
      {"pieces: is empty", ConvexShape{}},
      {"points: is empty", ConvexShape{{{}}}},
      {"pieces[1]: is empty", edited(two, [](auto& c) { c.pieces_C[1].clear(); })},
      {"pieces[1][0]: is not finite", edited(two, [](auto& c) { c.pieces_C[1][0].x() = kNaN; })},
      {"points[0]: is more than", ConvexShape{{{Vec3(0, 0, 1.1e9)}}}},
      {"pieces[1]: passes the 512 points",
       edited(two, [](auto& c) { c.pieces_C[1].resize(512, Vec3::Zero()); })},
      {"points: is a single point", ConvexShape{{{Vec3::Ones()}}}},
      {"points: is a single point", ConvexShape{{{Vec3::Ones(), Vec3::Ones()}}}},
      {"pieces: is a single point", edited(two, [](auto& c) { c.pieces_C[1] = c.pieces_C[0]; })},
      {"triangles: is a single point", edited(mesh,
                                              [](auto& m) {
                                                m.triangles = {{1, 1, 1}, {1, 1, 1}};
                                              })},
      {"triangles: is a single point",
       edited(mesh, [](auto& m) { m.vertices_C.assign(3, Vec3::Ones()); })},
      {"vertices: is empty", edited(mesh, [](auto& m) { m.vertices_C.clear(); })},
      {"vertices: holds 100001; at most 100000",
       edited(mesh, [](auto& m) { m.vertices_C.resize(100001, Vec3::Zero()); })},
      {"vertices[2]: is not finite", edited(mesh, [](auto& m) { m.vertices_C[2].z() = kNaN; })},
      {"triangles: is empty", edited(mesh, [](auto& m) { m.triangles.clear(); })},
      {"triangles: holds 100001; at most 100000",
       edited(mesh, [](auto& m) { m.triangles.resize(100001); })},
      {"triangles[0][2]: is 3, but there are 3 vertices",
       edited(mesh, [](auto& m) { m.triangles[0][2] = 3; })},
      {"the camera has no near quadrilateral", Camera{}},
      {"the camera has no near quadrilateral", Camera{3.1415926, 1.0, 1e9}},
  };
  for (const auto& [expected, shape] : cases) {
    EXPECT_THAT(Body::make(shape).error, ::testing::StartsWith(expected));
  }
  EXPECT_FALSE(fault_in(box) || fault_in(two) || fault_in(mesh) || fault_in(kCamera));
  const ConvexShape rod{{{Vec3::Zero(), Vec3::UnitX()}}};
  EXPECT_FALSE(fault_in(rod)) << "flat bodies and segments have extent";
}

}  // namespace
}  // namespace camway::motion
