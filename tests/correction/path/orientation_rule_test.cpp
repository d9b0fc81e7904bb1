// SPDX-License-Identifier: MIT
#include "daemon/correction/path/orientation_rule.h"

#include <gtest/gtest.h>

#include "daemon/motion/spline/bump.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/orientation_oracle.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::CubicPath;
using motion::Keyframe;
using motion::Pose;
using std::numbers::pi;

constexpr double kRounding_deg = testing::kOracleRounding_deg;

class RandomPolicies : public testing::Random {
 public:
  using Random::Random;

  Quat turn(double largest_rad) {
    return Quat(Eigen::AngleAxisd(uniform(0.0, largest_rad), in_cube(1.0).normalized()));
  }
  Pose pose() { return {in_cube(2.0), turn(pi)}; }
  OrientationPolicy policy() {
    OrientationPolicy policy;
    const std::array rules = {OrientationRule::kFree, OrientationRule::kLevel,
                              OrientationRule::kTarget};
    policy.rule = rules[static_cast<std::size_t>(uniform(0.0, 2.999))];
    policy.up_W = in_cube(1.0).normalized();
    policy.target_W = in_cube(3.0);
    policy.cone_rad = uniform(0.05, 1.5);
    if (uniform(0.0, 1.0) < 0.5 || policy.rule == OrientationRule::kFree)
      policy.max_turn_rad = uniform(0.01, 2.0);
    return policy;
  }
};

TEST(OrientationRule, RoomIsLeftExactlyWhereTheOracleSeesNoBreach) {
  RandomPolicies random(2401);
  int broken = 0;
  constexpr int kPoses = 20000;
  for (int i = 0; i < kPoses; ++i) {
    const OrientationPolicy policy = random.policy();
    const Pose before = random.pose();
    const Pose now{before.position + random.in_cube(0.5), random.turn(1.0) * before.orientation};
    const double room = rule_room(policy, now, before);
    const double breach_deg = testing::breach_deg(policy, now, before);
    broken += room < 0.0 ? 1 : 0;
    if (room >= 0.0) {
      EXPECT_LE(breach_deg, kRounding_deg);
    } else {
      EXPECT_GT(breach_deg, -kRounding_deg);
    }
  }
  EXPECT_GT(broken, kPoses / 10);
  EXPECT_LT(broken, 9 * kPoses / 10);
}

TEST(OrientationRule, WhatIsAllowedMeetsTheRuleAndTurnsAboutThePivot) {
  RandomPolicies random(2402);
  int met = 0;
  constexpr int kPoses = 5000;
  for (int i = 0; i < kPoses; ++i) {
    OrientationPolicy policy = random.policy();
    const bool is_single = policy.rule == OrientationRule::kFree || policy.max_turn_rad >= pi;
    const Pose before = random.pose();
    const Pose wanted{before.position + random.in_cube(0.5), random.turn(2.5) * before.orientation};
    const Vec3 pivot_C = random.in_cube(0.1);
    const Pose allowed = allowed_pose(policy, wanted, before, pivot_C);
    const double room = rule_room(policy, allowed, before);
    met += room >= 0.0 ? 1 : 0;
    // Close to the target every small step changes the direction to it.
    const bool is_next_to_target = (policy.target_W - wanted.position).norm() < 0.5;
    if (is_single && !is_next_to_target) {
      EXPECT_GE(room, 0.0) << i << " rule " << static_cast<int>(policy.rule);
    }
    EXPECT_LT((allowed.position + allowed.orientation * pivot_C -
               (wanted.position + wanted.orientation * pivot_C))
                  .norm(),
              1e-12);
  }
  EXPECT_GT(met, kPoses * 8 / 10) << "where two rules meet, mostly";
}

TEST(OrientationRule, LeavesAPoseThatIsAllowedAsItIs) {
  RandomPolicies random(2403);
  int same = 0;
  for (int i = 0; i < 2000; ++i) {
    const OrientationPolicy policy = random.policy();
    const Pose before = random.pose();
    const Pose back = allowed_pose(policy, before, before, random.in_cube(0.1));
    EXPECT_EQ(back.position, before.position);
    EXPECT_EQ(back.orientation.coeffs(), before.orientation.coeffs());
    const Pose wanted{before.position, random.turn(0.05) * before.orientation};
    same += allowed_pose(policy, wanted, before, Vec3::Zero()).orientation.coeffs() ==
                    wanted.orientation.coeffs()
                ? 1
                : 0;
  }
  EXPECT_GT(same, 500);
}

// When the camera looks straight up there is no horizon to tilt; beyond, it is upside down.
TEST(OrientationRule, LevelMayLookStraightUpAndTurnAboutTheViewThere) {
  OrientationPolicy policy;
  policy.rule = OrientationRule::kLevel;
  const Pose ahead{Vec3::Zero(), Quat::Identity()};
  const auto pitched = [](double angle_rad) {
    return Quat(Eigen::AngleAxisd(angle_rad, Vec3::UnitX()));
  };
  const Quat up = pitched(pi / 2.0);
  EXPECT_GE(rule_room(policy, {Vec3::Zero(), up}, ahead), 0.0);
  EXPECT_GE(rule_room(policy, {Vec3::Zero(), up * Eigen::AngleAxisd(1.0, Vec3::UnitZ())}, ahead),
            0.0);
  EXPECT_LT(rule_room(policy, {Vec3::Zero(), pitched(pi / 2.0 + 0.1)}, ahead), 0.0);
  EXPECT_LT(rule_room(policy, {Vec3::Zero(), Quat(Eigen::AngleAxisd(pi, Vec3::UnitZ()))}, ahead),
            0.0);
  const Pose over{Vec3::Zero(), pitched(pi / 2.0 + 0.3)};
  EXPECT_GE(rule_room(policy, over, over), 0.0) << "as it was";
  const Pose turned_back = allowed_pose(policy, over, ahead, Vec3::Zero());
  EXPECT_GE(rule_room(policy, turned_back, ahead), 0.0);
}

CubicPath random_path(RandomPolicies& random) {
  std::vector<Keyframe> keyframes;
  Quat orientation = random.turn(pi);
  for (int i = 0; i < 4; ++i) {
    keyframes.push_back({2.0 * i, {random.in_cube(2.0), orientation}});
    orientation = random.turn(0.8) * orientation;
  }
  return motion::interpolate_cubic(keyframes);
}

CubicPath with_random_bumps(const CubicPath& path, RandomPolicies& random) {
  const double size = std::exp(random.uniform(-6.0, -1.0));
  motion::BumpRow row{{2.0, 4.0, 6}, 2, {}};
  for (int i = 0; i < 3; ++i) {
    row.bumps.push_back({random.in_cube(size),
                         0.5 * Vec4(random.uniform(-size, size), random.uniform(-size, size),
                                    random.uniform(-size, size), random.uniform(-size, size))});
  }
  return motion::with_bumps(path, {&row, 1});
}

// Compares the proof with dense samples: no breach may be missed, and few paths may be refused
// without one.
TEST(OrientationRule, APathIsPassedOnlyIfNoSampleBreaksTheRule) {
  RandomPolicies random(2404);
  int passed = 0;
  int refused = 0;
  int refused_for_nothing = 0;
  for (int i = 0; i < 600; ++i) {
    const OrientationPolicy policy = random.policy();
    const CubicPath before = random_path(random);
    const CubicPath now = with_random_bumps(before, random);
    const bool is_passed = !first_breach(policy, now, before, 0.0, 6.0);
    const double worst_deg =
        testing::worst_breach_deg(policy, now.path(), before.path(), 0.0, 6.0, 1500);
    if (is_passed) {
      ++passed;
      EXPECT_LE(worst_deg, kRounding_deg) << i;
    } else {
      ++refused;
      refused_for_nothing += worst_deg < -0.05 ? 1 : 0;
    }
  }
  EXPECT_GT(passed, 150);
  EXPECT_GT(refused, 150);
  EXPECT_LT(refused_for_nothing, 12) << "of " << refused;
}

TEST(OrientationRule, SaysWhereAPathBreaksTheRule) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 4; ++i) keyframes.push_back({2.0 * i, {Vec3(0, 0, -i), Quat::Identity()}});
  const CubicPath before = motion::interpolate_cubic(keyframes);
  motion::BumpRow row{{2.0, 4.0, 8}, 4, {{Vec3::Zero(), {0, 0, 0, 0.3}}}};  // a roll at 3 s
  const CubicPath now = motion::with_bumps(before, {&row, 1});
  OrientationPolicy policy;
  policy.max_turn_rad = 0.2;
  const auto breach = first_breach(policy, now, before, 0.0, 6.0);
  ASSERT_TRUE(breach);
  EXPECT_GT(breach->t_begin_s, 2.5);
  EXPECT_LT(breach->t_end_s, 3.5);
  EXPECT_FALSE(first_breach(policy, now, before, 0.0, 2.5));
  policy.max_turn_rad = 1.5;
  EXPECT_FALSE(first_breach(policy, now, before, 0.0, 6.0));
  policy.max_turn_rad = pi;
  policy.rule = OrientationRule::kLevel;
  EXPECT_TRUE(first_breach(policy, now, before, 0.0, 6.0));
}

}  // namespace
}  // namespace camway::correction
