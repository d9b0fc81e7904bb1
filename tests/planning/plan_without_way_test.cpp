// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/planning/plan.h"
#include "tests/planning/plan_fixture.h"

// Requests without a way: with a proof, or without one.
namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;
using scene::Mesh;
using testing_plan::bulging_tour;
using testing_plan::planned;
using testing_plan::snapshot_of;

/// Six plates about a point, turned, with slits along all edges that no camera fits through. No
/// surface is closed, so there is no proof that there is no path.
Mesh room_of_plates(const Vec3& center) {
  constexpr double kHalf_m = 0.8;
  constexpr double kSlit_m = 0.002;
  const Quat turn_W(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        Vec3 at;
        at[axis] = side * kHalf_m;
        at[(axis + 1) % 3] = u * (kHalf_m - kSlit_m);
        at[(axis + 2) % 3] = v * (kHalf_m - kSlit_m);
        return Vec3(center + turn_W * at);
      };
      testing::add_triangle(mesh, corner(-1, -1), corner(1, -1), corner(1, 1));
      testing::add_triangle(mesh, corner(-1, -1), corner(1, 1), corner(-1, 1));
    }
  }
  return mesh;
}

TEST(PlanWithoutAWay, WithoutAWayOrAProofItIsPartialWithWhatRemains) {
  const PlanResult result = planned(
      *snapshot_of(room_of_plates(bulging_tour().keyframes[0].pose.position)), bulging_tour());
  EXPECT_EQ(result.status, Status::kPartial) << result.message;
  EXPECT_FALSE(result.remaining_collisions.empty());
  EXPECT_FALSE(result.path.empty());
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_EQ(result.keyframe, 0U) << "that cannot get out";
}

/// Two rooms, and a wall between them with a square hole of 12 cm.
Mesh rooms_with_a_hole() {
  Mesh mesh;
  testing::add_cuboid(mesh, {4, -0.2, -3}, {4.1, 3, -0.06});
  testing::add_cuboid(mesh, {4, -0.2, 0.06}, {4.1, 3, 3});
  testing::add_cuboid(mesh, {4, -0.2, -0.06}, {4.1, 0.94, 0.06});
  testing::add_cuboid(mesh, {4, 1.06, -0.06}, {4.1, 3, 0.06});
  testing::add_cuboid(mesh, {-2, -0.3, -3}, {12, -0.2, 3});
  testing::add_cuboid(mesh, {-2, 3, -3}, {12, 3.1, 3});
  testing::add_cuboid(mesh, {-2, -0.3, -3.1}, {12, 3.1, -3});
  testing::add_cuboid(mesh, {-2, -0.3, 3}, {12, 3.1, 3.1});
  testing::add_cuboid(mesh, {-2.1, -0.3, -3.1}, {-2, 3.1, 3.1});
  testing::add_cuboid(mesh, {12, -0.3, -3.1}, {12.1, 3.1, 3.1});
  testing::add_cuboid(mesh, {8.9, 0.9, -0.25}, {9.1, 1.1, -0.1});
  return mesh;
}

// A keyframe that was moved proves nothing of the request, but where a cage is about it, no search
// that turns the camera is worth its time.
TEST(PlanWithoutAWay, ACageAboutARepairedKeyframeEndsTheSearchAndIsNoProof) {
  PlanRequest request;
  request.camera = {.fov_x_rad = 1.4, .fov_y_rad = 1.05, .near_m = 0.15};
  request.keyframes = {{0.0, {{0, 1, 0}, Quat::Identity()}}, {0.0, {{9, 1, 0}, Quat::Identity()}}};
  request.options.repair_keyframes = true;
  const PlanResult result = planned(*snapshot_of(rooms_with_a_hole()), request);
  EXPECT_EQ(result.status, Status::kPartial) << result.message;
  EXPECT_EQ(result.keyframe_faults.size(), 1U);
  ASSERT_FALSE(result.corrections.empty());
  // The search for a way with room looks at 7,000 places here, that with turns at 42,000 more.
  EXPECT_LT(result.corrections[0].tried.lattice_points, 20'000);
}

TEST(PlanWithoutAWay, AKeyframeInAClosedBoxIsProvedInfeasible) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, 1}, {1, 1, 3});
  const PlanResult result = planned(*snapshot_of(std::move(mesh)), bulging_tour());
  EXPECT_EQ(result.status, Status::kInfeasible) << result.message;
  ASSERT_TRUE(result.infeasibility);
  EXPECT_EQ(result.infeasibility->keyframe_inside, 0U);
  EXPECT_EQ(result.infeasibility->triangles.size(), 12U);
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_FALSE(result.remaining_collisions.empty());
}

enum class Way { kNone, kOneBarGone, kFaceOpen };

// Returns bars 2 cm thick around a box of 1.2 m about the first keyframe, 5 cells of 0.24 m in each
// direction. On the face towards the next keyframe one bar is missing, which leaves holes of 0.22 m
// by 0.46 m, or all bars except those on its edges.
Mesh caged_keyframe(Way way) {
  Mesh mesh;
  const Vec3 center(0, 0, 2);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.6, 0.6}) {
      for (const int along : {(axis + 1) % 3, (axis + 2) % 3}) {
        for (int i = 0; i <= 5; ++i) {
          Vec3 from = center - Vec3::Constant(0.6);
          Vec3 to = center + Vec3::Constant(0.6);
          from[axis] = to[axis] = center[axis] + side;
          const int across = 3 - axis - along;
          from[across] = to[across] = center[across] - 0.6 + 0.24 * i;
          const bool is_front = axis == 2 && side < 0.0;
          if (is_front && way == Way::kFaceOpen && i > 0 && i < 5) continue;
          if (is_front && way == Way::kOneBarGone && along == 0 && i == 3) continue;
          testing::add_cuboid(mesh, from - Vec3::Constant(0.01), to + Vec3::Constant(0.01));
        }
      }
    }
  }
  return mesh;
}

PlanRequest tour_with_sides(double side_m) {
  PlanRequest request = bulging_tour();
  request.camera.near_m = 0.1;
  request.camera.fov_x_rad = request.camera.fov_y_rad = 2.0 * std::atan(0.5 * side_m / 0.1);
  return request;
}

TEST(PlanWithoutAWay, ACageWithHolesTooNarrowIsProvedInfeasible) {
  const auto snapshot = snapshot_of(caged_keyframe(Way::kNone));
  PlanRequest request = tour_with_sides(0.4);
  const PlanResult result = planned(*snapshot, request);
  ASSERT_EQ(result.status, Status::kInfeasible) << result.message;
  ASSERT_TRUE(result.infeasibility && result.infeasibility->cage);
  const correction::CageBox& cage = *result.infeasibility->cage;
  EXPECT_EQ(result.infeasibility->keyframe_inside, 0U);
  EXPECT_NEAR(cage.shortest_chord_m, 0.4, 1e-12);
  EXPECT_NEAR(cage.widest_hole_m, 0.22 * std::sqrt(2.0), 1e-9);
  EXPECT_TRUE(cage.box.contains(Vec3(0, 0, 1.9)));
  EXPECT_FALSE(result.certificate.certified);
  // Its holes are 31 cm wide, so a camera of 30 cm may get through as far as the proof knows.
  request.options.max_shrink = 0.25;
  const auto soon = base::Deadline::after_s(1.0);  // whether it does is not asked here
  EXPECT_NE(plan(*snapshot, request, soon).status, Status::kInfeasible);
  request.options.max_shrink = 0.1;
  EXPECT_EQ(planned(*snapshot, request).status, Status::kInfeasible);
}

TEST(PlanWithoutAWay, ACageWithAWayOutIsLeft) {
  const PlanResult result =
      planned(*snapshot_of(caged_keyframe(Way::kFaceOpen)), tour_with_sides(0.4));
  EXPECT_EQ(result.status, Status::kOk) << result.message;
}

// Sideways, a camera of 0.34 m passes a hole of 0.22 m by 0.46 m if it avoids the bar above; it
// passes no hole of a complete cage.
TEST(PlanWithoutAWay, AMissingBarIsAWayOutOfACage) {
  PlanRequest request = tour_with_sides(0.34);
  request.keyframes.clear();
  for (const double z : {2.0, 0.4, -2.0}) {
    request.keyframes.push_back(
        {2.0 - z, {{-0.1, 0.22, z}, testing::looking_along(Vec3::UnitX())}});
  }
  const auto closed = snapshot_of(caged_keyframe(Way::kNone));
  EXPECT_EQ(planned(*closed, request).status, Status::kInfeasible);
  const PlanResult out = planned(*snapshot_of(caged_keyframe(Way::kOneBarGone)), request);
  EXPECT_EQ(out.status, Status::kOk) << out.message;
  EXPECT_FALSE(out.collisions.empty());
}

TEST(PlanWithoutAWay, ASurfaceThatASmallerCameraIsBeyondIsNoProof) {
  Mesh mesh;  // holds the near quadrilateral of the first keyframe, and not its eye
  testing::add_cuboid(mesh, {-1, -1, 1}, {1, 1, 1.95});
  const auto snapshot = snapshot_of(std::move(mesh));
  PlanRequest request = bulging_tour();
  request.camera = {0.5, 0.5, 0.1};
  request.keyframes.erase(request.keyframes.begin() + 1);
  EXPECT_EQ(planned(*snapshot, request).status, Status::kInfeasible);
  request.options.max_shrink = 0.6;
  EXPECT_NE(planned(*snapshot, request).status, Status::kInfeasible);
}

// Two skins of a wall, with rims at a distance of 2 mm: a very flat body has a way out, so there is
// no proof. But no search finds a way, and it ends soon.
TEST(PlanWithoutAWay, NamesAKeyframeBetweenTheSkinsOfAWall) {
  const Quat turn_W(Eigen::AngleAxisd(0.3, Vec3(0.2, 1.0, 0.1).normalized()));
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    testing::add_cuboid(mesh, Vec3(-1.5, -1.2, 0.094 * side - 0.006),
                        Vec3(1.5, 1.2, 0.094 * side + 0.006));
    testing::add_cuboid(mesh, Vec3(1.51 * side - 0.008, -1.3, -0.2),
                        Vec3(1.51 * side + 0.008, 1.3, 0.2));
    testing::add_cuboid(mesh, Vec3(-1.6, 1.21 * side - 0.008, -0.2),
                        Vec3(1.6, 1.21 * side + 0.008, 0.2));
  }
  for (Vec3& vertex : mesh.vertices) vertex = turn_W * vertex;
  PlanRequest request;
  request.camera = {.fov_x_rad = 1.4, .fov_y_rad = 1.0, .near_m = 0.05};
  for (const Vec3& at : {Vec3(0, 0, 1), Vec3(0.4, 0.1, 0.06), Vec3(0, 0.2, -1)})
    request.keyframes.push_back({0.0, {turn_W * at, turn_W}});
  const PlanResult result = planned(*snapshot_of(std::move(mesh)), request);
  EXPECT_EQ(result.status, Status::kPartial);
  EXPECT_EQ(result.keyframe, 1U);
  ASSERT_EQ(result.shut_in.size(), 1U);
  EXPECT_EQ(result.shut_in[0].keyframe, 1U);
  EXPECT_TRUE(result.shut_in[0].may_hold(turn_W * Vec3(0.4, 0.1, 0.01)));
  EXPECT_LT(result.shut_in[0].region_W.diagonal().norm(), 4.5);
  EXPECT_THAT(result.message, ::testing::HasSubstr("keyframe 1 seems shut in: no way out of a "));
  std::int32_t points = 0;
  for (const correction::Correction& correction : result.corrections)
    points += correction.tried.lattice_points;
  EXPECT_LT(points, 500'000);
}

/// Returns the most places that searches for a way round looked at for one collision.
std::int32_t most_points(const PlanResult& result) {
  std::int32_t most = 0;
  for (const correction::Correction& correction : result.corrections)
    most = std::max(most, correction.tried.lattice_points);
  return most;
}

constexpr double kRoom_m = 4.0;         // from the middle of one hollow wall to the next
constexpr double kHalfCavity_m = 0.08;  // of the cavity in a wall
constexpr double kSheet_m = 0.01;

/// Adds the part of a hollow wall between two others: four boards on either side, with joints, and
/// studs that leave gaps between them and the boards. `axis`: the one across the wall.
void add_hollow_wall(Mesh& mesh, int axis, double at_m, double from_m, double joint_m) {
  constexpr double kBoard_m = (kRoom_m - 2.0 * (kHalfCavity_m + kSheet_m)) / 4.0;
  const auto add_box = [&](double across_m, double half_m, double along_m, double width_m,
                           double top_m) {
    Vec3 low(across_m - half_m, along_m, 0.0);
    Vec3 high(across_m + half_m, along_m + width_m, top_m);
    if (axis == 1) std::swap(low.x(), low.y());
    if (axis == 1) std::swap(high.x(), high.y());
    testing::add_cuboid(mesh, low, high);
  };
  for (int board = 0; board < 4; ++board) {
    const double begin_m = from_m + kHalfCavity_m + kSheet_m + board * kBoard_m;
    for (const double side : {-1.0, 1.0}) {
      const double middle_m = at_m + side * (kHalfCavity_m + 0.5 * kSheet_m);
      add_box(middle_m, 0.5 * kSheet_m, begin_m, kBoard_m - joint_m, 3.0);
    }
    add_box(at_m, 0.03, begin_m - 0.02, 0.04, 2.9);
  }
}

/// A building of rooms between hollow walls, which all hold one cavity. Above the ceilings of the
/// rooms is an attic to which the cavity is open.
Mesh building_of_hollow_walls(int rooms, double joint_m) {
  const double length_m = kRoom_m * rooms;
  Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -0.1}, {length_m + 1, length_m + 1, 0});
  testing::add_cuboid(mesh, {-1, -1, 3.2}, {length_m + 1, length_m + 1, 3.3});
  for (int axis = 0; axis < 2; ++axis) {
    for (int wall = 0; wall <= rooms; ++wall) {
      for (int room = 0; room < rooms; ++room)
        add_hollow_wall(mesh, axis, kRoom_m * wall, kRoom_m * room, joint_m);
    }
  }
  for (int x = 0; x < rooms; ++x) {
    for (int y = 0; y < rooms; ++y) {
      testing::add_cuboid(mesh, {kRoom_m * x + 0.095, kRoom_m * y + 0.095, 2.6},
                          {kRoom_m * (x + 1) - 0.095, kRoom_m * (y + 1) - 0.095, 2.62});
    }
  }
  return mesh;
}

// The cavity reaches through the whole building, so the search of it ends before all of it was
// looked at. The ball of the search fits through joints of 6 mm, and not through those of 3 mm; the
// camera fits through none.
TEST(PlanWithoutAWay, NamesAKeyframeInACavityThatIsTooLargeToBeSearched) {
  PlanRequest request;
  request.camera = {.fov_x_rad = 1.4, .fov_y_rad = 1.0, .near_m = 0.05};
  for (const Vec3& at : {Vec3(2, 2, 1.5), Vec3(4.0, 5.6, 1.3), Vec3(6, 6, 1.5)})
    request.keyframes.push_back({0.0, {at, testing::looking_along(Vec3::UnitY())}});
  for (const double joint_m : {0.003, 0.006}) {
    SCOPED_TRACE(joint_m);
    const PlanResult result = planned(*snapshot_of(building_of_hollow_walls(3, joint_m)), request);
    EXPECT_EQ(result.status, Status::kPartial) << result.message;
    EXPECT_EQ(result.keyframe, 1U);
    EXPECT_FALSE(result.deadline_reached);
    EXPECT_THAT(result.message, ::testing::HasSubstr(
                                    "no search found a way out of the place where keyframe 1 is;"));
    EXPECT_LT(most_points(result), 800'000);
  }
}

}  // namespace
}  // namespace camway::planning
