// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "daemon/geometry/triangle_distance.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using geometry::Triangle;
using geometry::Vec3;
using geometry::Vec4;
using testing::Draw;

constexpr double kAll_m = std::numeric_limits<double>::infinity();
constexpr double kRowLever_m = 0.37;
// Bound on the rounding of distances and planes of points within 5 m: some ten roundings of that
// size, and the distance's own. For a short distance the error of its direction is larger in
// proportion.
constexpr double kRowRounding_m = 1e-12;
constexpr double kShort_m = 1e-2;
// Images have at least half of unit length, and the body rotates four times as fast as its image.
// Derivatives of a point's position are below its distance from the eye times powers of that.
constexpr double kTurn_per_m = 4.0 / (0.5 * kRowLever_m);
constexpr double kSize_m = 0.6;
constexpr double kSecond_per_m = kSize_m * kTurn_per_m * kTurn_per_m;
constexpr double kThird_per_m2 = kSecond_per_m * kTurn_per_m;

motion::Body made(const motion::BodyShape& shape) { return *motion::Body::make(shape); }

/// Scattered triangles, and a pose of the body that is free of them.
struct RowsCase {
  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body{testing::small_camera()};
  collision::DetectOptions detect;
  OrientationPolicy policy;
  Vec4 reference;
  StackedPoint point;

  [[nodiscard]] FreeSpace space() const {
    return FreeSpace({collision::Obstacles(index), body, detect}, policy);
  }
  [[nodiscard]] motion::Pose pose(const StackedPoint& at) const {
    return motion::pose_of(reference, unstacked(at, kRowLever_m));
  }
  [[nodiscard]] std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> triangles(mesh.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0U);
    return triangles;
  }
  [[nodiscard]] std::vector<ContactRow> rows(double horizon_m = kAll_m) const {
    FreeSpace space = this->space();
    std::vector<ContactRow> rows;
    add_contact_rows(space, {point, reference, kRowLever_m, space.may_turn()}, all(), horizon_m,
                     rows);
    return rows;
  }
  /// Returns a vertex of the body in the world.
  [[nodiscard]] Vec3 vertex_W(const StackedPoint& at, std::size_t vertex) const {
    const motion::Pose pose = this->pose(at);
    return pose.position + pose.orientation * body.triangles_C()[vertex / 3][vertex % 3];
  }
  /// Returns the body's triangle `part` in the world.
  [[nodiscard]] Triangle part_W(const StackedPoint& at, std::size_t part) const {
    return {vertex_W(at, 3 * part), vertex_W(at, 3 * part + 1), vertex_W(at, 3 * part + 2)};
  }
};

RowsCase random_rows(Draw& draw) {
  RowsCase c;
  c.mesh = testing::scattered_triangles(draw, 12, 0.5);
  c.index = scene::SceneIndex::build(c.mesh);
  if (draw.integer(0, 1) == 1) {
    c.body = made(motion::BoxShape{draw.in_cube(0.2), Vec3(0.3, 0.2, 0.1)});
  }
  c.detect.clearance_m = draw.integer(0, 1) * draw.uniform(0.0, 0.02);
  c.reference = geometry::wxyz(draw.turn(3.0));
  FreeSpace space = c.space();
  do {
    c.point.head<3>() = draw.in_cube(1.5);
    c.point.tail<4>() = kRowLever_m * draw.uniform(0.5, 2.0) * geometry::wxyz(draw.turn(3.0));
  } while (!(space.gap_m(c.pose(c.point), 2.0 * kShort_m) > kShort_m));
  return c;
}

TEST(Contacts, LeaveAsMuchRoomAsTheDistanceIs) {
  Draw draw(4301);
  for (int run = 0; run < 200; ++run) {
    const RowsCase c = random_rows(draw);
    const FreeSpace space = c.space();
    std::map<std::pair<std::uint32_t, std::size_t>, double> least_m;
    for (const ContactRow& row : c.rows()) {
      const auto place = least_m.try_emplace({row.triangle, row.vertex / 3}, kAll_m).first;
      place->second = std::min(place->second, row.room_m);
    }
    ASSERT_EQ(least_m.size(), c.mesh.triangles.size() * c.body.triangles_C().size());
    for (const auto& [pair, room_m] : least_m) {
      const double distance_m =
          geometry::triangle_distance(c.index.triangle(pair.first), c.part_W(c.point, pair.second));
      ASSERT_NEAR(room_m, distance_m - space.keep_m(), kRowRounding_m / kShort_m) << run;
    }
  }
}

// The derivative of the vertex's distance from the plane, which stays fixed.
TEST(Contacts, PointWhereTheRoomGrows) {
  Draw draw(4302);
  for (int run = 0; run < 100; ++run) {
    const RowsCase c = random_rows(draw);
    for (const ContactRow& row : c.rows()) {
      const Vec3 away_W = row.direction.head<3>();
      ASSERT_NEAR(away_W.norm(), 1.0, kRowRounding_m);
      for (Eigen::Index i = 0; i < 7; ++i) {
        // The error of central differences is a sixth of the third derivative.
        constexpr double kStep_m = 1e-4;
        const StackedPoint step = kStep_m * StackedPoint::Unit(i);
        const Vec3 moved =
            c.vertex_W(c.point + step, row.vertex) - c.vertex_W(c.point - step, row.vertex);
        ASSERT_NEAR(row.direction[i], away_W.dot(moved) / (2.0 * kStep_m),
                    kThird_per_m2 / 6.0 * kStep_m * kStep_m + kRowRounding_m / kStep_m)
            << run << " dimension " << i;
      }
    }
  }
}

// The bounds of the rows on the distance are violated by terms of second order only.
TEST(Contacts, BoundTheDistanceAfterASmallStep) {
  Draw draw(4303);
  int pairs = 0;
  for (int run = 0; run < 200; ++run) {
    const RowsCase c = random_rows(draw);
    const FreeSpace space = c.space();
    StackedPoint step = draw.stacked(1.0);
    step *= 1e-3 / step.norm();
    std::map<std::pair<std::uint32_t, std::size_t>, double> promised_m;
    for (const ContactRow& row : c.rows()) {
      const auto place = promised_m.try_emplace({row.triangle, row.vertex / 3}, kAll_m).first;
      place->second = std::min(place->second, row.room_m + row.direction.dot(step));
    }
    for (const auto& [pair, room_m] : promised_m) {
      const double distance_m = geometry::triangle_distance(c.index.triangle(pair.first),
                                                            c.part_W(c.point + step, pair.second));
      ASSERT_GT(distance_m - space.keep_m(), room_m - 0.5 * kSecond_per_m * step.squaredNorm())
          << run;
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 2000);
}

// A body of many triangles; the oracle has one body for each of them.
TEST(Contacts, AreTheTightestOfATriangleWhereThereAreMany) {
  constexpr std::size_t kMost = 48;
  Draw draw(4306);
  RowsCase c = random_rows(draw);
  motion::MeshShape shape;
  for (std::uint32_t i = 0; i < 3 * 40; i += 3) {
    const Vec3 center_C = draw.in_cube(0.2);
    for (int k = 0; k < 3; ++k) shape.vertices_C.push_back(center_C + draw.in_cube(0.05));
    shape.triangles.push_back({i, i + 1, i + 2});
  }
  std::map<std::uint32_t, std::vector<double>> rooms_m;
  for (const auto& [a, b, d] : shape.triangles) {
    c.body = made(motion::MeshShape{{shape.vertices_C[a], shape.vertices_C[b], shape.vertices_C[d]},
                                    {{0, 1, 2}}});
    for (const ContactRow& row : c.rows()) rooms_m[row.triangle].push_back(row.room_m);
  }
  c.body = made(shape);
  std::map<std::uint32_t, std::vector<double>> kept_m;
  for (const ContactRow& row : c.rows()) kept_m[row.triangle].push_back(row.room_m);
  ASSERT_EQ(kept_m.size(), c.mesh.triangles.size());
  for (auto& [triangle, kept] : kept_m) {
    std::vector<double>& all = rooms_m[triangle];
    ASSERT_EQ(all.size(), 3 * shape.triangles.size());
    std::ranges::sort(all);
    std::ranges::sort(kept);
    all.resize(kMost);
    EXPECT_EQ(kept, all);
  }
}

TEST(Contacts, LeaveOutWhatIsBeyondTheHorizon) {
  Draw draw(4304);
  for (int run = 0; run < 50; ++run) {
    const RowsCase c = random_rows(draw);
    std::vector<ContactRow> expected = c.rows();
    const double horizon_m = draw.uniform(0.1, 1.0);
    std::erase_if(expected, [&](const ContactRow& row) { return row.room_m > horizon_m; });
    const std::vector<ContactRow> rows = c.rows(horizon_m);
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].direction, expected[i].direction);
      ASSERT_EQ(rows[i].vertex, expected[i].vertex);
    }
  }
}

TEST(Contacts, AskForNoTurnWhereNoneIsAllowed) {
  Draw draw(4305);
  RowsCase c = random_rows(draw);
  const std::vector<ContactRow> turning = c.rows();
  c.policy.rule = OrientationRule::kKeep;
  const std::vector<ContactRow> rows = c.rows();
  ASSERT_EQ(rows.size(), turning.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].direction.head<3>(), turning[i].direction.head<3>());
    EXPECT_TRUE(rows[i].direction.tail<4>().isZero(0.0));
    EXPECT_FALSE(turning[i].direction.tail<4>().isZero(1e-6));
  }
}

// A side of the bounds keeps each vertex inside by the ball's radius only.
TEST(Contacts, OfASideAreOfEveryVertex) {
  Draw draw(4306);
  for (int run = 0; run < 100; ++run) {
    RowsCase c = random_rows(draw);
    if (run % 2 == 0) c.body = made(motion::SphereShape{draw.in_cube(0.3), 0.15});
    geometry::Bounds bounds;
    bounds.min_W.y() = -4.0;
    bounds.max_W.z() = 3.0;
    FreeSpace space({collision::Obstacles(c.index).within(bounds), c.body, c.detect}, c.policy);
    const std::vector<std::uint32_t> sides = {collision::Obstacles::number_of_side(1),
                                              collision::Obstacles::number_of_side(5)};
    std::vector<ContactRow> rows;
    add_contact_rows(space, {c.point, c.reference, kRowLever_m, true}, sides, kAll_m, rows);
    ASSERT_EQ(rows.size(), 2 * 3 * c.body.triangles_C().size());
    for (const ContactRow& row : rows) {
      const std::size_t side = collision::Obstacles::side_of(row.triangle);
      const Vec3 away_W = geometry::Bounds::inward(side);
      EXPECT_EQ(Vec3(row.direction.head<3>()), away_W);
      const Vec3 vertex_W = c.vertex_W(c.point, row.vertex);
      EXPECT_NEAR(row.room_m, bounds.depth_m(side, vertex_W) - c.body.ball_radius_m(),
                  kRowRounding_m);
      for (Eigen::Index i = 0; i < 7; ++i) {
        constexpr double kStep_m = 1e-4;
        const StackedPoint step = kStep_m * StackedPoint::Unit(i);
        const Vec3 moved =
            c.vertex_W(c.point + step, row.vertex) - c.vertex_W(c.point - step, row.vertex);
        EXPECT_NEAR(row.direction[i], away_W.dot(moved) / (2.0 * kStep_m),
                    kThird_per_m2 / 6.0 * kStep_m * kStep_m + kRowRounding_m / kStep_m);
      }
    }
  }
}

}  // namespace
}  // namespace camway::correction
