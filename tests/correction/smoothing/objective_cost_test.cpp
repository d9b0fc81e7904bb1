// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/objective_cost.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "daemon/collision/clearance.h"
#include "daemon/motion/path/measures.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using geometry::Vec3;
using motion::CubicPath;
using testing::Draw;

/// A camera above a floor that extends beyond its view.
struct CostCase {
  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body{testing::small_camera()};
  collision::DetectOptions detect;

  CostCase() {
    testing::add_cuboid(mesh, {-50, -2, -50}, {50, -1, 50});
    index = scene::SceneIndex::build(mesh);
  }
  [[nodiscard]] FreeSpace space() const {
    return FreeSpace({collision::Obstacles(index), body, detect});
  }
  [[nodiscard]] ObjectiveCost cost(Objective objective, const CubicPath& path,
                                   const CubicPath& original) const {
    FreeSpace space = this->space();
    return objective_cost(objective, path, original, space, base::Deadline::never());
  }
};

CubicPath straight(const Vec3& from, const Vec3& to, double duration_s) {
  return testing::problem_of_leg({{0.0, {from, geometry::Quat::Identity()}},
                                  {duration_s, {to, geometry::Quat::Identity()}}},
                                 0)
      .path;
}

// An answer reports the same numbers.
TEST(ObjectiveCost, IsWhatMeasuresSay) {
  const CostCase c;
  Draw draw(6101);
  for (int run = 0; run < 50; ++run) {
    std::vector<motion::Keyframe> keyframes;
    for (int i = 0; i < 4; ++i) keyframes.push_back({1.7 * i, {draw.in_cube(3.0), draw.turn(1.0)}});
    const CubicPath path = testing::problem_of_leg(keyframes, 1).path;
    keyframes[1].pose.position += draw.in_cube(1.0);
    const CubicPath original = testing::problem_of_leg(keyframes, 1).path;
    const motion::PathMeasures measures = motion::measure(path.path(), original.path());
    const auto value = [&](Objective objective) { return c.cost(objective, path, original).value; };
    // Both sample each piece, one of them twice as densely.
    EXPECT_NEAR(value(Objective::kShortest), measures.length_m, 2e-3 * measures.length_m);
    EXPECT_EQ(value(Objective::kClosest), closeness_cost(path, original, c.space().closeness()));
    EXPECT_NEAR(value(Objective::kSmoothest), measures.bending_energy_m2_per_s3,
                1e-9 * measures.bending_energy_m2_per_s3);
  }
}

// At a constant height everything is known: the missing clearance is constant, and the way is its
// length.
TEST(ObjectiveCost, OfSafestGrowsWithTheWayNearTheScene) {
  const CostCase c;
  const double radius_m = c.space().ball_radius_m();
  const double comfort_m = kComfort * radius_m;
  const double low_m = -std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
  for (const double share : {0.1, 0.5, 0.9}) {
    const Vec3 up(0, -1.0 - low_m + share * comfort_m, 0);
    const CubicPath path = straight(up, up + Vec3(3, 0, 0), 2.0);
    const ObjectiveCost cost = c.cost(Objective::kSafest, path, path);
    EXPECT_NEAR(cost.value, 3.0 * (1.0 - share) * (1.0 - share), 0.02) << share;
    // As exact as the clearance of an answer.
    EXPECT_LE(cost.least_gap_m, share * comfort_m * (1.0 + 1e-9));
    EXPECT_GE(cost.least_gap_m, share * comfort_m * (1.0 - collision::kClearanceTolerance) - 1e-9);
    // It does not depend on the duration.
    const CubicPath slow = straight(up, up + Vec3(3, 0, 0), 20.0);
    EXPECT_NEAR(c.cost(Objective::kSafest, slow, slow).value, cost.value, 1e-6);
  }
  const CubicPath far = straight({0, 10, 0}, {3, 10, 0}, 2.0);
  EXPECT_EQ(c.cost(Objective::kSafest, far, far).value, 0.0);
  EXPECT_EQ(c.cost(Objective::kSafest, far, far).least_gap_m, comfort_m);
}

// The gap is what lies beyond the required clearance.
TEST(ObjectiveCost, OfSafestHasTheGapBeyondTheClearance) {
  CostCase c;
  const CubicPath path = straight({-2, -0.8, 0}, {2, -0.8, 0}, 4.0);
  const double gap_m = c.cost(Objective::kSafest, path, path).least_gap_m;
  ASSERT_LT(gap_m, kComfort * c.space().ball_radius_m());
  c.detect.clearance_m = 0.5 * gap_m;
  EXPECT_NEAR(c.cost(Objective::kSafest, path, path).least_gap_m, 0.5 * gap_m, 0.05 * gap_m);
}

TEST(ObjectiveCost, IsBetterOnlyIfLessAndNoNearer) {
  EXPECT_TRUE(is_better({0.9, 0.1}, {1.0, 0.1}));
  EXPECT_FALSE(is_better({1.0, 0.1}, {1.0, 0.1}));
  EXPECT_FALSE(is_better({0.99999, 0.1}, {1.0, 0.1})) << "not worth a change";
  EXPECT_FALSE(is_better({0.9, 0.09}, {1.0, 0.1})) << "nearer";
  EXPECT_TRUE(is_better({0.9, 0.2}, {1.0, 0.1}));
}

}  // namespace
}  // namespace camway::correction
