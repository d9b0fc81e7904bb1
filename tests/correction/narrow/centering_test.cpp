// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/centering.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using testing_search::SearchScene;

const Vec3 kBox_m(0.5, 0.3, 1.2);
constexpr double kGapRounding_m = 1e-9;  // of poses that many small turns have led to

motion::Body box() { return *motion::Body::make(motion::BoxShape{Vec3::Zero(), kBox_m}); }

/// A wall about the plane z = 0 with a hole about the z axis.
scene::Mesh wall_with_hole(double width_m, double height_m, double thickness_m) {
  const double x = 0.5 * width_m;
  const double y = 0.5 * height_m;
  const double z = 0.5 * thickness_m;
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-3, -3, -z}, {-x, 3, z});
  testing::add_cuboid(mesh, {x, -3, -z}, {3, 3, z});
  testing::add_cuboid(mesh, {-x, -3, -z}, {x, -y, z});
  testing::add_cuboid(mesh, {-x, y, -z}, {x, 3, z});
  return mesh;
}

TEST(Centered, FindsTheMiddleOfAHole) {
  testing::Random random(5201);
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    const double spare_m = random.uniform(0.02, 0.1);
    const SearchScene scene(
        wall_with_hole(kBox_m.x() + spare_m, kBox_m.y() + spare_m, random.uniform(0.05, 0.6)),
        box());
    FreeSpace space = scene.space();
    const motion::Pose start{Vec3(0.3 * spare_m, -0.4 * spare_m, random.uniform(-0.1, 0.1)),
                             Quat(Eigen::AngleAxisd(0.1 * spare_m, Vec3::UnitY()))};
    const double before_m = scene.distance_m(start);
    const Centered found = centered(space, start, 1.0, Vec3::UnitZ(), Deadline::never());
    EXPECT_GT(found.gap_m, before_m);
    EXPECT_GT(found.gap_m, 0.95 * 0.5 * spare_m);
    EXPECT_LE(found.gap_m, 0.5 * spare_m + kGapRounding_m);
    EXPECT_NEAR(found.gap_m, scene.distance_m(found.pose), kGapRounding_m);
    // It moved across the axis only.
    EXPECT_NEAR(found.pose.position.z(), start.position.z(), kGapRounding_m);
  }
}

TEST(Centered, NeverLosesRoom) {
  testing::Random random(5202);
  constexpr double kEnough_m = 0.5;
  int checked = 0;
  for (int run = 0; run < 40; ++run) {
    SCOPED_TRACE(run);
    const SearchScene scene(testing::scattered_triangles(random, 40, 0.6));
    const motion::Pose start{random.in_cube(1.0), random.rotation()};
    const double before_m = scene.distance_m(start);
    if (!(before_m > 1e-3)) continue;
    ++checked;
    FreeSpace space = scene.space();
    const Centered found = centered(space, start, kEnough_m, Vec3::Zero(), Deadline::never());
    EXPECT_GE(found.gap_m, std::min(before_m, kEnough_m) - kGapRounding_m);
    EXPECT_NEAR(found.gap_m, std::min(scene.distance_m(found.pose), kEnough_m), kGapRounding_m);
  }
  EXPECT_GT(checked, 20);
}

// A hundredth of room to spare: the body has to be turned within half a degree.
TEST(Fitter, FitsABodyIntoAHoleThatIsLittleLarger) {
  testing::Random random(5203);
  for (const double spare : {0.01, 0.02, 0.05, 0.1}) {
    for (int run = 0; run < 6; ++run) {
      SCOPED_TRACE(std::to_string(spare) + ", run " + std::to_string(run));
      const SearchScene scene(
          wall_with_hole((1.0 + spare) * kBox_m.x(), (1.0 + spare) * kBox_m.y(), 0.2), box());
      FreeSpace space = scene.space();
      const motion::Pose place{0.03 * random.in_cube(1.0),
                               Quat(Eigen::AngleAxisd(random.uniform(-0.07, 0.07), Vec3::UnitZ()))};
      const Deadline never = Deadline::never();
      Fitter fitter(space, never);
      const std::optional<Centered> found = fitter.fitted(place);
      ASSERT_TRUE(found);
      EXPECT_GT(found->gap_m, 0.0);
      EXPECT_GT(found->gap_m, 0.8 * 0.5 * spare * kBox_m.y());
      EXPECT_NEAR(found->gap_m, scene.distance_m(found->pose), kGapRounding_m);
      EXPECT_LT(std::abs(found->pose.position.z()), 0.6) << "it is still in the hole";
    }
  }
}

TEST(Fitter, EndsAtTheDeadline) {
  const SearchScene scene(wall_with_hole(1.01 * kBox_m.x(), 1.01 * kBox_m.y(), 0.2), box());
  FreeSpace space = scene.space();
  const Deadline passed = Deadline::after_s(0.0);
  Fitter fitter(space, passed);
  const motion::Pose place{Vec3(0.01, 0.01, 0.0), Quat::Identity()};
  EXPECT_EQ(fitter.free_scale(place), 0.0);
  EXPECT_FALSE(fitter.fitted(place));
}

TEST(Fitter, FitsNothingIntoAHoleThatIsTooSmall) {
  testing::Random random(5204);
  const SearchScene scene(wall_with_hole(0.99 * kBox_m.x(), 0.99 * kBox_m.y(), 0.2), box());
  FreeSpace space = scene.space();
  const Deadline never = Deadline::never();
  Fitter fitter(space, never);
  for (int run = 0; run < 6; ++run) {
    const motion::Pose place{0.02 * random.in_cube(1.0), Quat::Identity()};
    EXPECT_LT(fitter.free_scale(place), 1.0);
    EXPECT_GT(fitter.free_scale(place), 0.0);
    const std::optional<Centered> found = fitter.fitted(place);
    EXPECT_FALSE(found && std::abs(found->pose.position.z()) < 0.6) << run;
  }
}

}  // namespace
}  // namespace camway::correction
