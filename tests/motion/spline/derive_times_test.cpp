// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/derive_times.h"

#include <numbers>

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using geometry::Quat;
using test::Vec3;
using testing::Random;

const Quat kLevel = Quat::Identity();

void expect_increasing_from_zero(const std::vector<double>& times_s) {
  ASSERT_FALSE(times_s.empty());
  EXPECT_EQ(times_s[0], 0.0);
  for (std::size_t i = 1; i < times_s.size(); ++i) EXPECT_LT(times_s[i - 1], times_s[i]);
}

TEST(DeriveTimes, AStraightMoveTakesItsLength) {
  const std::vector<Pose> poses = {{Vec3(0, 0, 0), kLevel}, {Vec3(3, 4, 0), kLevel}};
  EXPECT_DOUBLE_EQ(derive_times_s(poses)[1], 5.0 / kNominalSpeed_m_per_s);
}

TEST(DeriveTimes, AnotherSpeedIsThatOfTheChordsAlone) {
  const std::vector<Pose> poses = {{Vec3(0, 0, 0), kLevel},
                                   {Vec3(3, 4, 0), kLevel},
                                   {Vec3(3, 4, 0), test::turned(Vec3(1, 2, 3), 1.5)}};
  const std::vector<double> times_s = derive_times_s(poses, 2.5);
  EXPECT_DOUBLE_EQ(times_s[1], 5.0 / 2.5);
  EXPECT_NEAR(times_s[2] - times_s[1], 1.5 / kNominalTurnRate_rad_per_s, 8.0 * test::kEpsilon);
}

TEST(DeriveTimes, TurningOnTheSpotTakesItsAngle) {
  const std::vector<Pose> poses = {
      {Vec3(1, 1, 1), kLevel},
      {Vec3(1, 1, 1), test::turned(Vec3(1, 2, 3), 0.75 * std::numbers::pi)}};
  EXPECT_NEAR(derive_times_s(poses)[1], 0.75 * std::numbers::pi / kNominalTurnRate_rad_per_s,
              8.0 * test::kEpsilon);
}

TEST(DeriveTimes, MoveAndTurnAreBlended) {
  const std::vector<Pose> poses = {{Vec3(0, 0, 0), kLevel},
                                   {Vec3(3, 0, 0), test::turned(Vec3(0, 1, 0), 2.0)}};
  EXPECT_DOUBLE_EQ(derive_times_s(poses)[1],
                   std::hypot(3.0 / kNominalSpeed_m_per_s, 2.0 / kNominalTurnRate_rad_per_s));
}

TEST(DeriveTimes, RepeatedPosesGetTheShortestStep) {
  const std::vector<Pose> poses = {{Vec3(0, 0, 0), kLevel},
                                   {Vec3(2, 0, 0), kLevel},
                                   {Vec3(2, 0, 0), kLevel},
                                   {Vec3(6, 0, 0), kLevel}};
  const std::vector<double> times_s = derive_times_s(poses);
  expect_increasing_from_zero(times_s);
  EXPECT_NEAR(times_s[2] - times_s[1], kShortestStep * 2.0, 4.0 * test::kEpsilon);
}

TEST(DeriveTimes, RestOnlyGetsEqualSteps) {
  const std::vector<Pose> poses(4, Pose{Vec3(1, 2, 3), kLevel});
  EXPECT_EQ(derive_times_s(poses), (std::vector<double>{0.0, 1.0, 2.0, 3.0}));
}

TEST(DeriveTimes, SignOfTheQuaternionDoesNotMatter) {
  Random random(51);
  std::vector<Pose> poses = test::random_poses(random, 50);
  const std::vector<double> expected_s = derive_times_s(poses);
  for (Pose& pose : poses) {
    if (random.chance(0.5)) pose.orientation.coeffs() = -pose.orientation.coeffs();
  }
  EXPECT_EQ(derive_times_s(poses), expected_s);
}

TEST(DeriveTimes, ReversedPosesTakeReversedSteps) {
  Random random(52);
  std::vector<Pose> poses = test::random_poses(random, 50);
  const std::vector<double> forward_s = derive_times_s(poses);
  std::ranges::reverse(poses);
  const std::vector<double> backward_s = derive_times_s(poses);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(backward_s[i], forward_s.back() - forward_s[49 - i],
                50.0 * test::kEpsilon * forward_s.back());
}

TEST(DeriveTimes, ClustersAmongMetresStillIncrease) {
  Random random(53);
  std::vector<Pose> poses;
  for (int i = 0; i < 2000; ++i) {
    poses.push_back({random.normal_vector(3.0), random.rotation()});
    poses.push_back({poses.back().position + random.normal_vector(1e-9), poses.back().orientation});
  }
  expect_increasing_from_zero(derive_times_s(poses));
}

}  // namespace
}  // namespace camway::motion
