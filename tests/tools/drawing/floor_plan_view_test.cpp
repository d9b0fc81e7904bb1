// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/random.h"
#include "tools/drawing/answer_plan.h"
#include "tools/drawing/legend.h"

namespace camway::draw {
namespace {

using geometry::Vec3;

motion::MeshShape tetrahedra(std::size_t count, testing::Random& random) {
  std::uniform_real_distribution<double> place(-0.4, 0.4);
  motion::MeshShape mesh;
  for (std::uint32_t i = 0; i < 4 * count; ++i) {
    mesh.vertices_C.emplace_back(place(random), place(random), place(random));
    if (i % 4 != 3) continue;
    mesh.triangles.insert(mesh.triangles.end(),
                          {{i - 3, i - 2, i - 1}, {i - 3, i - 2, i}, {i - 2, i - 1, i}});
  }
  return mesh;
}

FloorPlan plan_with(const motion::BodyShape& shape) {
  planning::PlanRequest request;
  request.body = shape;
  FloorPlan plan;
  set_body(request, plan);
  return plan;
}

bool names(const FloorPlan& plan, const std::string& text) {
  const std::vector<LegendEntry> legend = legend_of(plan, /*has_several_storeys=*/false);
  return std::ranges::any_of(legend, [&](const LegendEntry& entry) { return entry.text == text; });
}

// Convex outlines are the same if they reach as far in every direction.
TEST(BodyOutline, ReachesAsFarAsTheBody) {
  constexpr double kComputed_m = 1e-12;
  constexpr double kOfCircle = 0.99;  // a polygon in a circle
  testing::Random random(8);
  const motion::BodyShape shapes[] = {
      motion::BoxShape{Vec3(0.1, -0.3, 0.0), Vec3(0.7, 1.6, 0.6)},
      motion::SphereShape{Vec3(0.0, 0.2, 0.1), 0.35},
      motion::ConvexShape{{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 1}, {0, 0.5, 0.5}}}},
      tetrahedra(5, random),
  };
  for (const motion::BodyShape& shape : shapes) {
    const FloorPlan plan = plan_with(shape);
    const motion::Body body = *motion::Body::make(shape);
    const motion::Pose pose{{1.0, 2.0, 3.0}, random.rotation()};
    const std::vector<PlanPoint> outline = outline_on_paper(plan, pose);
    EXPECT_EQ(outline.front(), outline.back());
    for (int i = 0; i < 100; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / 100;
      const PlanPoint direction(std::cos(angle_rad), std::sin(angle_rad));
      double drawn_m = -HUGE_VAL;
      for (const PlanPoint& p : outline) drawn_m = std::max(drawn_m, direction.dot(p));
      double points_m = -HUGE_VAL;
      for (const geometry::Triangle& triangle : body.triangles_C()) {
        for (const Vec3& vertex_C : triangle) {
          const PlanPoint p = to_plan(pose.position + pose.orientation * vertex_C, plan.up);
          points_m = std::max(points_m, direction.dot(p));
        }
      }
      EXPECT_LE(drawn_m, points_m + body.ball_radius_m() + kComputed_m);
      EXPECT_GE(drawn_m, points_m + kOfCircle * body.ball_radius_m() - kComputed_m);
    }
  }
}

TEST(BodyOutline, OfManyTrianglesIsThatOfTheirBox) {
  testing::Random random(9);
  const motion::MeshShape mesh = tetrahedra(1000, random);
  const FloorPlan plan = plan_with(mesh);
  EXPECT_EQ(plan.body_C.size(), 8U);
  geometry::Box box;
  for (const Vec3& corner : plan.body_C) box.extend(corner);
  EXPECT_TRUE(box.isApprox(motion::Body::make(mesh)->box_C()));
}

TEST(BodyOutline, IsNamedInTheLegendInPlaceOfTheNearQuadrilateral) {
  const FloorPlan body = plan_with(motion::BoxShape{Vec3::Zero(), Vec3(0.7, 1.6, 0.6)});
  EXPECT_TRUE(names(body, "body"));
  EXPECT_FALSE(names(body, "near quadrilateral"));
  EXPECT_FALSE(names(body, "curves of its corners"));
  FloorPlan camera;
  set_body({}, camera);
  EXPECT_TRUE(names(camera, "near quadrilateral"));
  EXPECT_TRUE(names(camera, "curves of its corners"));
  EXPECT_FALSE(names(camera, "body"));
  EXPECT_EQ(outline_on_paper(camera, {}).size(), 5U);
}

}  // namespace
}  // namespace camway::draw
