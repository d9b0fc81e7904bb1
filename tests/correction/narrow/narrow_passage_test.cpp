// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/narrow_passage.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;

constexpr double kPassageMargin_m = 0.002;
constexpr double kShortSide_m = 0.3;

motion::Body wide_camera() {
  return motion::Body(
      motion::Camera{2.0 * std::atan(1.0), 2.0 * std::atan(0.5 * kShortSide_m / 0.2), 0.2});
}

/// A plate of 2 cm in the plane z = `z_m` with a square
/// hole about the z axis.
void add_plate(scene::Mesh& mesh, double z_m, double hole_m) {
  const double half_m = 0.5 * hole_m;
  testing::add_cuboid(mesh, {-3, -3, z_m - 0.01}, {-half_m, 3, z_m + 0.01});
  testing::add_cuboid(mesh, {half_m, -3, z_m - 0.01}, {3, 3, z_m + 0.01});
  testing::add_cuboid(mesh, {-half_m, -3, z_m - 0.01}, {half_m, -half_m, z_m + 0.01});
  testing::add_cuboid(mesh, {-half_m, half_m, z_m - 0.01}, {half_m, 3, z_m + 0.01});
}

void turn(scene::Mesh& mesh, const Quat& turn_W) {
  for (Vec3& vertex : mesh.vertices) vertex = turn_W * vertex;
}

std::vector<Vec3> turned(std::vector<Vec3> way_W, const Quat& turn_W) {
  for (Vec3& point : way_W) point = turn_W * point;
  return way_W;
}

/// The passages where the interpolated path turns from the one end orientation to the other.
std::vector<NarrowPassage> passages_of(FreeSpace& space, const std::vector<Vec3>& way_W,
                                       const SignedPose& from, const SignedPose& to) {
  const std::vector<motion::Pose> interpolated = {motion::unsigned_pose(from),
                                                  motion::unsigned_pose(to)};
  return narrow_passages(space, way_W, from, to, interpolated, kPassageMargin_m, Deadline::never());
}

// Expects a free motion from one side of every plate to the other.
void expect_passed(const SearchScene& scene, const std::vector<NarrowPassage>& passages,
                   const std::vector<double>& plates_m, const Quat& turn_W) {
  ASSERT_EQ(passages.size(), plates_m.size());
  FreeSpace space = scene.space();
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const NarrowPassage& passage = passages[i];
    EXPECT_TRUE(is_proved_free(scene, passage.poses, kPassageMargin_m));
    const auto z_m = [&](const SignedPose& pose) {
      return (turn_W.conjugate() * space.center_W(motion::unsigned_pose(pose))).z();
    };
    const double radius_m = space.ball_radius_m();
    EXPECT_GT(z_m(passage.poses.front()), plates_m[i] + 0.9 * radius_m);
    EXPECT_LT(z_m(passage.poses.back()), plates_m[i] - 0.9 * radius_m);
    EXPECT_LT(passage.first, passage.last);
  }
}

// The diagonal of the hole is from 1.08 to 1.5 times the short side. The way is off its middle.
TEST(NarrowPassages, LeadThroughHolesLittleWiderThanTheShortSide) {
  testing::Random random(4801);
  std::uniform_real_distribution<double> off(-0.03, 0.03);
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    const Quat turn_W = random.rotation();
    const double hole_m = kShortSide_m * (1.08 + 0.02 * run) / std::sqrt(2.0);
    scene::Mesh mesh;
    add_plate(mesh, 0.0, hole_m);
    turn(mesh, turn_W);
    const SearchScene scene(mesh, wide_camera());
    FreeSpace space = scene.space();
    const double x_m = off(random);
    const double y_m = off(random);
    const std::vector<Vec3> way_W =
        turned({{x_m, 0.2, 1.5}, {x_m, y_m, 0.2}, {-x_m, y_m, -0.2}, {-x_m, 0.3, -1.5}}, turn_W);
    const SignedPose from = motion::signed_pose({way_W.front(), random.rotation()});
    const SignedPose to = motion::signed_pose({way_W.back(), random.rotation()});
    const std::vector<NarrowPassage> passages = passages_of(space, way_W, from, to);
    expect_passed(scene, passages, {0.0}, turn_W);
  }
}

/// A plate without thickness in the plane z = 0 with a hole, its corners in turn about the z axis.
void add_plate_with_hole(scene::Mesh& mesh, const std::vector<Vec3>& hole_W) {
  for (std::size_t i = 0; i < hole_W.size(); ++i) {
    const Vec3& a = hole_W[i];
    const Vec3& b = hole_W[(i + 1) % hole_W.size()];
    testing::add_triangle(mesh, a, b, 20.0 * a);
    testing::add_triangle(mesh, b, 20.0 * b, 20.0 * a);
  }
}

// The body fits where its middle is not in the middle of the hole.
TEST(NarrowPassages, LeadThroughTrianglesAndSlits) {
  testing::Random random(4802);
  std::uniform_real_distribution<double> off(-0.2, 0.2);
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    const Quat turn_W = random.rotation();
    const double ratio = 1.35 + 0.02 * run;  // of the side, or the length, to the short side
    const double side_m = ratio * kShortSide_m;
    scene::Mesh mesh;
    double free_m = 0.0;  // along the y axis, to each side
    if (run % 2 == 0) {
      const double high_m = std::sqrt(3.0) / 6.0 * side_m;
      add_plate_with_hole(
          mesh, {{0.5 * side_m, -high_m, 0}, {0, 2.0 * high_m, 0}, {-0.5 * side_m, -high_m, 0}});
      free_m = high_m;
    } else {
      const double half_m = 0.08 * side_m;
      free_m = 0.5 * side_m;
      add_plate_with_hole(
          mesh,
          {{half_m, -free_m, 0}, {half_m, free_m, 0}, {-half_m, free_m, 0}, {-half_m, -free_m, 0}});
    }
    turn(mesh, turn_W);
    const SearchScene scene(mesh, wide_camera());
    FreeSpace space = scene.space();
    const double y_m = off(random) * free_m;
    const std::vector<Vec3> way_W =
        turned({{0, 0.2, 1.5}, {0, y_m, 0.2}, {0, y_m, -0.2}, {0, 0.3, -1.5}}, turn_W);
    const SignedPose from = motion::signed_pose({way_W.front(), random.rotation()});
    const SignedPose to = motion::signed_pose({way_W.back(), random.rotation()});
    const std::vector<NarrowPassage> passages = passages_of(space, way_W, from, to);
    expect_passed(scene, passages, {0.0}, turn_W);
  }
}

// A hundredth of room to spare: orientations a few degrees apart do not fit.
TEST(NarrowPassages, LeadABoxThroughAHoleThatIsLittleLarger) {
  testing::Random random(4804);
  for (int run = 0; run < 3; ++run) {
    SCOPED_TRACE(run);
    const Quat turn_W = random.rotation();
    const double side_m = 0.3;
    scene::Mesh mesh;
    add_plate(mesh, 0.0, 1.01 * side_m);
    turn(mesh, turn_W);
    const SearchScene scene(
        mesh, *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(side_m, side_m, 1.0)}));
    FreeSpace space = scene.space();
    const std::vector<Vec3> way_W =
        turned({{0, 0.2, 2.0}, {0, 0, 0.2}, {0, 0, -0.2}, {0, 0.3, -2.0}}, turn_W);
    const SignedPose from = motion::signed_pose({way_W.front(), random.rotation()});
    const SignedPose to = motion::signed_pose({way_W.back(), random.rotation()});
    const std::vector<NarrowPassage> passages = passages_of(space, way_W, from, to);
    ASSERT_EQ(passages.size(), 1U);
    const Guide& poses = passages.front().poses;
    EXPECT_TRUE(is_proved_free(scene, poses, 0.1 * 0.01 * side_m));
    EXPECT_GT((turn_W.conjugate() * poses.front().position).z(), 0.3);
    EXPECT_LT((turn_W.conjugate() * poses.back().position).z(), -0.3);
  }
}

TEST(NarrowPassages, AreInTheOrderOfTheWay) {
  const double hole_m = 0.25;
  scene::Mesh mesh;
  add_plate(mesh, 1.0, hole_m);
  add_plate(mesh, -1.0, hole_m);
  const SearchScene scene(mesh, wide_camera());
  FreeSpace space = scene.space();
  const std::vector<Vec3> way_W = {{0, 0, 2.5}, {0, 0, 0.5}, {0, 0, -0.5}, {0, 0, -2.5}};
  const SignedPose from{way_W.front(), Vec4::UnitX()};
  const SignedPose to{way_W.back(), Vec4::UnitX()};
  const std::vector<NarrowPassage> passages = passages_of(space, way_W, from, to);
  expect_passed(scene, passages, {1.0, -1.0}, Quat::Identity());
  EXPECT_EQ(passages[0].first, 0U);
  EXPECT_EQ(passages[1].first, 2U);
}

/// Straight through a hole of that size.
std::vector<NarrowPassage> passages_of_hole(double hole_m) {
  scene::Mesh mesh;
  add_plate(mesh, 0.0, hole_m);
  const SearchScene scene(mesh, wide_camera());
  FreeSpace space = scene.space();
  const std::vector<Vec3> way_W = {{0, 0, 1.5}, {0, 0, -1.5}};
  const SignedPose from{way_W.front(), Vec4::UnitX()};
  const SignedPose to{way_W.back(), Vec4::UnitX()};
  return passages_of(space, way_W, from, to);
}

TEST(NarrowPassages, NoneWhereTheBodyCannotPassOrItsBallFits) {
  EXPECT_TRUE(passages_of_hole(0.9 * kShortSide_m / std::sqrt(2.0)).empty());
  EXPECT_EQ(passages_of_hole(1.2 * kShortSide_m / std::sqrt(2.0)).size(), 1U);
  EXPECT_TRUE(passages_of_hole(1.0).empty());
}

// In a moment: there is a place for each quarter of the ball's radius.
TEST(NarrowPassages, NoneOnWaysWithoutAnEnd) {
  scene::Mesh mesh;
  add_plate(mesh, 0.0, 0.25);
  const SearchScene scene(mesh, wide_camera());
  FreeSpace space = scene.space();
  for (const double far_m : {1e5, 1e9, 1e300}) {
    const std::vector<Vec3> way_W = {{0, 0, 1.5}, {0, 0, -1.5}, {0, 0, -far_m}};
    const SignedPose from{way_W.front(), Vec4::UnitX()};
    const SignedPose to{way_W.back(), Vec4::UnitX()};
    EXPECT_TRUE(passages_of(space, way_W, from, to).empty());
  }
}

}  // namespace
}  // namespace camway::correction
