// SPDX-License-Identifier: MIT
#include "tools/drawing/barrier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/random.h"
#include "tests/tools/drawing/drawn_house.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/storey_panels.h"

namespace camway::draw {
namespace {

using geometry::Vec3;

/// Whether a point on paper is within closed lines, by the edges that a ray to the right crosses.
bool is_within(const std::vector<SectionLine>& lines, const PlanPoint& p) {
  bool is_inside = false;
  for (const SectionLine& line : lines) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const PlanPoint& a = line.points[i];
      const PlanPoint& b = line.points[(i + 1) % line.points.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > p.x()) is_inside = !is_inside;
    }
  }
  return is_inside;
}

Vec3 point_between(testing::Random& random, double low, double high) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

FloorSection storey_at(double height_m, double floor_m) {
  FloorSection storey;
  storey.height_m = height_m;
  storey.floor_m = floor_m;
  return storey;
}

/// The section of a box that is turned has exactly the points that are in the box.
TEST(Barrier, OfACageIsItsBoxWhereverItIsTurned) {
  testing::Random random(kDrawSeed);
  for (int trial = 0; trial < 50; ++trial) {
    planning::Infeasibility proof;
    proof.cage.emplace();
    proof.cage->box = {point_between(random, -2.0, -0.5), point_between(random, 0.5, 2.0)};
    proof.cage->orientation = random.rotation();
    const Barrier barrier = barrier_of(proof, {});
    for (const SceneUp up : {SceneUp::kY, SceneUp::kZ}) {
      const FloorSection storey = storey_at(random.uniform(-0.4, 0.4), -1.0);
      const std::vector<SectionLine> lines = barrier_section(barrier, up, storey);
      ASSERT_FALSE(lines.empty());
      for (const SectionLine& line : lines) EXPECT_TRUE(line.closed);
      for (int i = 0; i < 50; ++i) {
        Vec3 point = point_between(random, -3.0, 3.0);
        (up == SceneUp::kY ? point.y() : point.z()) = storey.height_m;
        EXPECT_EQ(is_within(lines, to_plan(point, up)),
                  proof.cage->box.contains(proof.cage->orientation.conjugate() * point));
      }
    }
  }
}

/// A house with a closed box of 2 m on the lower floor, which takes the last twelve triangles.
scene::Mesh house_with_safe() {
  scene::Mesh mesh = small_house();
  add_box(mesh, {0.5, 0.1, 0.5}, {2.5, 2.1, 2.5});
  return mesh;
}

planning::Infeasibility proof_of_safe(const scene::Mesh& mesh) {
  planning::Infeasibility proof;
  proof.keyframe_inside = 1;
  proof.keyframe_outside = 0;
  proof.triangles.resize(12);
  std::iota(proof.triangles.begin(), proof.triangles.end(),
            static_cast<std::uint32_t>(mesh.triangles.size() - 12));
  return proof;
}

TEST(Barrier, OfASurfaceIsItsTrianglesAlone) {
  const scene::Mesh mesh = house_with_safe();
  planning::Infeasibility proof = proof_of_safe(mesh);
  proof.triangles.push_back(1'000'000);  // an answer file may say anything
  const Barrier barrier = barrier_of(proof, mesh);
  ASSERT_EQ(barrier.surface.triangles.size(), 12U);
  const auto lines = barrier_section(barrier, SceneUp::kY, storey_at(1.5, 0.0));
  for (const PlanPoint& in : {PlanPoint(0.6, 0.6), PlanPoint(2.4, 2.4)}) {
    EXPECT_TRUE(is_within(lines, in));
  }
  for (const PlanPoint& out : {PlanPoint(0.4, 1.0), PlanPoint(4.5, 1.5), PlanPoint(3.1, 1.0)}) {
    EXPECT_FALSE(is_within(lines, out));
  }
  EXPECT_FALSE(barrier_section(barrier, SceneUp::kY, storey_at(2.5, 0.0)).empty())
      << "lower than the cut";
  EXPECT_TRUE(barrier_section(barrier, SceneUp::kY, storey_at(4.5, 3.0)).empty())
      << "on the storey below";
}

TEST(Barrier, IsOnItsStoreyWithTheSidesOfItsKeyframes) {
  FloorPlan plan;
  plan.mesh = house_with_safe();
  plan.keyframes = {{0.0, {{4.5, 4.5, 3.0}, {}}}, {1.0, {{1.5, 1.5, 1.5}, {}}}};
  plan.keyframes[0].pose.orientation.setIdentity();
  plan.keyframes[1].pose.orientation.setIdentity();
  plan.barrier = barrier_of(proof_of_safe(plan.mesh), plan.mesh);
  const std::vector<Panel> panels = storey_panels(plan);
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_FALSE(panels[0].barrier.empty());
  EXPECT_TRUE(panels[1].barrier.empty());
  EXPECT_EQ(panels[0].keyframes.at(0).remark, "inside, 1.50 m");
  EXPECT_EQ(panels[1].keyframes.at(0).remark, "outside, 4.50 m");
  const std::string purple = "rgb(80%,47.45098%,65.490196%)";
  EXPECT_THAT(floor_plan_svg(plan), ::testing::HasSubstr(purple));
  plan.barrier.reset();
  EXPECT_THAT(floor_plan_svg(plan), ::testing::Not(::testing::HasSubstr(purple)));
}

}  // namespace
}  // namespace camway::draw
