// SPDX-License-Identifier: MIT
#include "daemon/motion/motion_bound.h"

#include <numbers>

#include "daemon/motion/camera.h"
#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::Random;
using test::Vec3;
using test::Vec4;

/// The largest motion from the middle that dense samples show.
MotionBound sampled_motion(const Segment& segment, double u0, double u1) {
  const Pose middle = pose_at(segment, (u0 + u1) / 2.0);
  MotionBound largest;
  for (int i = 0; i <= 400; ++i) {
    const Pose pose = pose_at(segment, std::min(u1, u0 + (u1 - u0) * i / 400.0));
    largest.translation_m =
        std::max(largest.translation_m, (pose.position - middle.position).norm());
    largest.turn_rad =
        std::max(largest.turn_rad, test::rotation_angle_rad(pose.orientation, middle.orientation));
  }
  return largest;
}

// Evaluating a pose and the angle between two rounds too: this much of the samples is not motion.
constexpr double kSampleRounding_rad = 16.0 * test::kEpsilon;

TEST(MotionBound, HoldsAtEverySample) {
  Random random(41);
  for (int i = 0; i < 2000; ++i) {
    const Segment segment = test::random_segment(random, random.log_uniform(1e-9, 3.0));
    const double length = random.log_uniform(1e-9, 1.0);
    const double u0 = random.uniform(0.0, 1.0 - length);
    const double u1 = u0 + length;
    const MotionBound bound = motion_bound(segment, u0, u1);
    const MotionBound seen = sampled_motion(segment, u0, u1);
    ASSERT_LE(seen.translation_m, bound.translation_m) << i << " length " << length;
    ASSERT_LE(std::min(seen.turn_rad - kSampleRounding_rad, std::numbers::pi), bound.turn_rad)
        << i << " length " << length;
    ASSERT_LE(bound.turn_rad, std::numbers::pi);
  }
}

TEST(MotionBound, IsTightOnShortStretches) {
  Random random(42);
  for (int i = 0; i < 500; ++i) {
    const Segment segment = test::random_segment(random, 0.3);
    const double u0 = random.uniform(0.0, 0.99);
    const double u1 = u0 + 1e-4;
    // Where a curve stands still its control points shrink only as fast as the next derivative.
    const SegmentDerivatives at = derivatives_at(segment, u0);
    const double duration_s = segment.t1_s - segment.t0_s;
    if (at.velocity_m_per_s.norm() * duration_s < 0.05) continue;
    if (at.orientation_rate_per_s.norm() * duration_s < 0.05) continue;
    const MotionBound bound = motion_bound(segment, u0, u1);
    const MotionBound seen = sampled_motion(segment, u0, u1);
    EXPECT_LE(bound.translation_m, 1.05 * seen.translation_m);
    EXPECT_LE(bound.turn_rad, 1.05 * seen.turn_rad);
  }
}

TEST(MotionBound, OfTheWholeIsThatOfTheSegment) {
  Random random(43);
  const Segment segment = test::random_segment(random, 0.3);
  EXPECT_EQ(motion_bound(segment).translation_m, motion_bound(segment, 0.0, 1.0).translation_m);
  EXPECT_EQ(motion_bound(segment).turn_rad, motion_bound(segment, 0.0, 1.0).turn_rad);
}

TEST(MotionBound, SaysNothingOfTurnsPastTheCone) {
  Random random(44);
  Segment segment = test::random_segment(random, 0.0);
  segment.orientation[6] = -segment.orientation[0];
  EXPECT_EQ(motion_bound(segment).turn_rad, std::numbers::pi);
  segment.orientation.fill(Vec4::Zero());
  EXPECT_EQ(motion_bound(segment).turn_rad, std::numbers::pi);
}

TEST(MotionBound, OfRestIsRounding) {
  Random random(45);
  Segment segment;
  segment.t1_s = 1.0;
  segment.position.fill(random.vector(1e3));
  segment.orientation.fill(random.unit_four_vector());
  const MotionBound bound = motion_bound(segment);
  EXPECT_LE(bound.translation_m, 1.01 * kTranslationRounding * segment.position[0].norm());
  EXPECT_LE(bound.turn_rad, 3.0 * kConeAngleRounding);
  EXPECT_GT(bound.turn_rad, 0.0);
}

// Small turns are where an arc cosine would report zero or 1e-8: the bound must follow the true
// angle down to rounding.
TEST(MotionBound, FollowsSmallTurns) {
  for (double angle_rad = 1e-2; angle_rad > 1e-12; angle_rad /= 10.0) {
    Segment segment;
    segment.t1_s = 1.0;
    segment.position.fill(Vec3::Zero());
    for (std::size_t i = 0; i < 7; ++i) {
      const double half_rad = angle_rad / 2.0 * (static_cast<double>(i) / 3.0 - 1.0);
      segment.orientation[i] = Vec4(std::cos(half_rad), 0.0, std::sin(half_rad), 0.0);
    }
    const double turn_rad = motion_bound(segment).turn_rad;
    EXPECT_GE(turn_rad, angle_rad);
    EXPECT_LE(turn_rad, angle_rad * 1.001 + 3.0 * kConeAngleRounding);
  }
}

TEST(Deviation, HoldsForEveryPointOfTheBody) {
  Random random(46);
  const Corners corners_C = near_corners_C({1.4, 1.0, 0.3});
  const double radius_m = body_radius_m(corners_C);
  for (int i = 0; i < 500; ++i) {
    const Segment segment = test::random_segment(random, random.log_uniform(1e-6, 3.0));
    const double allowed_m = deviation_m(motion_bound(segment), radius_m);
    const Corners middle = corners_W(corners_C, pose_at(segment, 0.5));
    for (int k = 0; k <= 100; ++k) {
      const Corners there = corners_W(corners_C, pose_at(segment, k / 100.0));
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_LE((there[c] - middle[c]).norm(), allowed_m + 32.0 * test::kEpsilon * radius_m);
    }
  }
}

TEST(Deviation, OfABodyTurnedRoundIsItsDiameter) {
  for (const double turn_rad : {std::numbers::pi, 10.0}) {  // more than half a turn is no more
    EXPECT_GE(deviation_m({0.25, turn_rad}, 0.5), 1.25);
    EXPECT_LE(deviation_m({0.25, turn_rad}, 0.5), 1.25 * (1.0 + 8.0 * test::kEpsilon));
  }
  EXPECT_GE(deviation_m({0.25, 0.0}, 0.5), 0.25);
  EXPECT_LE(deviation_m({0.25, 0.0}, 0.5), 0.25 * (1.0 + 8.0 * test::kEpsilon));
}

}  // namespace
}  // namespace camway::motion
