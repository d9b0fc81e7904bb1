// SPDX-License-Identifier: MIT
#include "daemon/motion/path/stretch.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "daemon/motion/body/camera.h"
#include "tests/motion/fifty_digits.h"
#include "tests/motion/random_motion.h"
#include "tests/support/sanitizer.h"

namespace camway::motion::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 placed(const Stretch& stretch, const Vec3& point_C) {
  return stretch.R_WC * point_C + stretch.eye_W;
}

/// Returns the largest distance of a corner, at samples of the stretch, from its place at the
/// middle.
double sampled_reach_m(const Segment& segment, double u0, double u1, const Stretch& stretch,
                       const Corners& corners_C, int samples) {
  double largest_m = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double u = std::min(u1, u0 + (u1 - u0) * i / samples);
    for (const Vec3& corner_C : corners_C) {
      largest_m = std::max(largest_m,
                           distance_from_exact_m(segment, u, corner_C, placed(stretch, corner_C)));
    }
  }
  return largest_m;
}

/// Returns the largest distance of a corner, at samples of the stretch, from the line between its
/// ends.
double sampled_bend_m(const Segment& segment, double u0, double u1, const Stretch& stretch,
                      const Corners& corners_C, int samples) {
  double largest_m = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double u = std::min(u1, u0 + (u1 - u0) * i / samples);
    const double ratio = u1 > u0 ? (u - 0.5 * (u0 + u1)) / (0.5 * (u1 - u0)) : 0.0;
    for (const Vec3& corner_C : corners_C) {
      const Vec3 arm_W = stretch.R_WC * corner_C;
      const Vec3 step_W = stretch.eye_step_W + stretch.turn_step_W.cross(arm_W);
      const Vec3 there = arm_W + stretch.eye_W + ratio * step_W;
      largest_m = std::max(largest_m, distance_from_exact_m(segment, u, corner_C, there));
    }
  }
  return largest_m;
}

// From a camera of a millimetre to one of ten metres, from the origin to 1e6 m away, from whole
// segments to stretches with rounding only, with orientation control points that nearly cancel.
TEST(Stretch, ReachHoldsAgainstFiftyDigits) {
  Random random(20261);
  for (int run = 0; run < testing::runs(1'500); ++run) {
    const double place_m = random.log_uniform(1e-3, 1e6);
    const double path_m = random.log_uniform(1e-6, 1e3);
    Segment segment = random_segment(random, random.log_uniform(1e-6, 3.0));
    const Vec3 place = random.normal_vector(place_m);
    for (Vec3& point : segment.position) point = place + random.normal_vector(path_m);
    const Corners corners_C = near_corners_C(
        {random.uniform(0.2, 2.5), random.uniform(0.2, 2.5), random.log_uniform(1e-3, 10.0)});
    const double width = random.log_uniform(1e-16, 1.0);
    const double u0 = random.uniform(0.0, 1.0 - width);
    const double u1 = u0 + width;
    const Stretch stretch = SegmentMotion(segment).around(u0, u1);
    const double radius_m = body_radius_m(corners_C);
    const double seen_m = sampled_reach_m(segment, u0, u1, stretch, corners_C, 6);
    ASSERT_LE(seen_m, stretch.reach_m(radius_m)) << "run " << run << ", width " << width;
    ASSERT_LE(stretch.rounding_m(radius_m), stretch.reach_m(radius_m));
    // The ratio of the sample is rounded as well, by less than this fraction of the step.
    const double ratio_m = 8.0 * kEpsilon / width * stretch.reach_m(radius_m);
    ASSERT_LE(sampled_bend_m(segment, u0, u1, stretch, corners_C, 6),
              stretch.bend_m(radius_m) + ratio_m)
        << "run " << run << ", width " << width;
  }
}

// The gain of the direction: halving a stretch halves its reach and quarters its bend.
TEST(Stretch, BendFallsWithTheSquareOfTheLength) {
  Random random(20267);
  for (int run = 0; run < 200; ++run) {
    const Segment segment = random_segment(random, 0.5);
    const SegmentMotion motion(segment);
    const Stretch whole = motion.around(0.5, 0.5 + 0x1p-8);
    const Stretch half = motion.around(0.5, 0.5 + 0x1p-9);
    EXPECT_LE(half.bend_m(0.5), 0.27 * whole.bend_m(0.5)) << "run " << run;
    EXPECT_LE(whole.bend_m(0.5), 0.2 * whole.reach_m(0.5)) << "run " << run;
  }
}

TEST(Stretch, AtOneInstantReachIsRounding) {
  Random random(20262);
  double worst = 0.0;
  for (int run = 0; run < 2'000; ++run) {
    Segment segment = random_segment(random, random.log_uniform(1e-3, 1.0));
    const Vec3 place = random.normal_vector(random.log_uniform(1e-3, 1e6));
    for (Vec3& point : segment.position) point += place;
    const Corners corners_C = near_corners_C({1.5, 1.0, random.log_uniform(1e-3, 10.0)});
    const double radius_m = body_radius_m(corners_C);
    const double u = random.uniform(0.0, 1.0);
    const Stretch stretch = SegmentMotion(segment).around(u, u);
    const double bound_m = stretch.rounding_m(radius_m);
    EXPECT_LE(stretch.reach_m(radius_m), bound_m * (1.0 + 64.0 * kEpsilon));
    const double seen_m = sampled_reach_m(segment, u, u, stretch, corners_C, 1);
    ASSERT_LE(seen_m, bound_m) << "run " << run;
    worst = std::max(worst, seen_m / bound_m);
    // The bound is useful only if it is far below the resolution of collisions.
    double extent_m = 0.0;
    for (const Vec3& point : segment.position) {
      extent_m = std::max(extent_m, (point - segment.position[0]).norm());
    }
    EXPECT_LE(bound_m, 3e-11 * radius_m + 256.0 * kEpsilon * extent_m +
                           8.0 * kEpsilon * (place.norm() + extent_m));
  }
  std::printf("worst share of the bound: %.4f\n", worst);
  EXPECT_GT(worst, 1e-4);
}

TEST(Stretch, IsTightOnShortStretches) {
  Random random(20263);
  for (int run = 0; run < 300; ++run) {
    const Segment segment = random_segment(random, 0.3);
    const Corners corners_C = near_corners_C({1.5, 1.0, 0.05});
    const double u0 = random.uniform(0.0, 0.99);
    const double u1 = u0 + 1e-4;
    const Stretch stretch = SegmentMotion(segment).around(u0, u1);
    const double seen_m = sampled_reach_m(segment, u0, u1, stretch, corners_C, 2);
    // Translation and rotation may cancel at every corner; the bound adds them.
    const SegmentDerivatives at = derivatives_at(segment, u0);
    const double duration_s = segment.t1_s - segment.t0_s;
    const double speed_m = at.velocity_m_per_s.norm() * duration_s;
    const double turn_m =
        2.0 * body_radius_m(corners_C) * at.orientation_rate_per_s.norm() * duration_s;
    if (speed_m < 20.0 * turn_m) continue;
    EXPECT_LE(stretch.reach_m(body_radius_m(corners_C)), 1.12 * seen_m) << "run " << run;
  }
}

// An arc cosine would report zero or 1e-8 for small rotations. The bound must follow the true angle
// down to rounding.
TEST(Stretch, FollowsSmallTurns) {
  for (double angle_rad = 1e-2; angle_rad > 1e-11; angle_rad /= 10.0) {
    Segment segment;
    segment.t1_s = 1.0;
    segment.position.fill(Vec3::Zero());
    for (std::size_t i = 0; i < 7; ++i) {
      const double half_rad = angle_rad / 2.0 * (static_cast<double>(i) / 3.0 - 1.0);
      segment.orientation[i] = Vec4(std::cos(half_rad), 0.0, std::sin(half_rad), 0.0);
    }
    const double sine = SegmentMotion(segment).around(0.0, 1.0).turn_sine;
    EXPECT_GE(sine, std::sin(angle_rad / 2.0));
    EXPECT_LE(sine, 0.5 * angle_rad * 1.001 + 64.0 * kEpsilon);
  }
}

TEST(Stretch, OfRestIsRounding) {
  Random random(20264);
  Segment segment;
  segment.t1_s = 1.0;
  segment.position.fill(random.normal_vector(1e3));
  segment.orientation.fill(geometry::wxyz(random.rotation()));
  const Stretch stretch = SegmentMotion(segment).around(0.0, 1.0);
  EXPECT_EQ(stretch.eye_W, segment.position[0]);
  EXPECT_EQ(stretch.travel_m, 0.0);
  EXPECT_LE(stretch.reach_m(0.5), 8.0 * kEpsilon * 3e3 + 100.0 * kEpsilon);
  EXPECT_GT(stretch.reach_m(0.5), 0.0);
}

TEST(Stretch, ATurnOfWhichNothingIsKnownIsTheDiameter) {
  Random random(20265);
  Segment segment = random_segment(random, 0.0);
  segment.position.fill(Vec3::Zero());
  segment.orientation[6] = -segment.orientation[0];
  const Stretch turned = SegmentMotion(segment).around(0.0, 1.0);
  EXPECT_EQ(turned.turn_sine, 1.0);
  EXPECT_NEAR(turned.reach_m(0.5), 1.0, 1e-12);
  EXPECT_GE(turned.reach_m(0.5), 1.0);
}

TEST(Stretch, AVanishingOrientationIsOneOfWhichNothingIsKnown) {
  for (const double size : {0.0, 1e-200, 1e200}) {
    Segment segment;
    segment.t1_s = 1.0;
    segment.position.fill(Vec3::Zero());
    segment.orientation.fill(size * Vec4(0.5, 0.5, -0.5, 0.5));
    const Stretch stretch = SegmentMotion(segment).around(0.25, 0.5);
    EXPECT_EQ(stretch.turn_sine, 1.0) << size;
    EXPECT_EQ(stretch.turn_rounding_sine, 1.0) << size;
    EXPECT_TRUE(stretch.R_WC.allFinite()) << size;
  }
}

TEST(Stretch, OfNumbersWithoutMeaningHasNoFiniteReach) {
  for (const double bad : {kInfinity, -kInfinity, std::nan(""), 1e308}) {
    for (const bool in_position : {true, false}) {
      Random random(20266);
      Segment segment = random_segment(random, 0.1);
      if (in_position) segment.position[2].y() = bad;
      if (!in_position) segment.orientation[3].z() = bad;
      const Stretch stretch = SegmentMotion(segment).around(0.0, 1.0);
      // A huge orientation is finite, and then only the diameter is known.
      const bool unknown = !(stretch.reach_m(0.5) < kInfinity) || stretch.turn_sine == 1.0;
      EXPECT_TRUE(unknown) << bad << (in_position ? " position" : " orientation");
      EXPECT_TRUE(!in_position || !(stretch.reach_m(0.5) < 1e300)) << bad;
    }
  }
}

TEST(Stretch, StandingAtAPoseIsThatPose) {
  Random random(20267);
  const Pose pose{random.normal_vector(3.0), random.rotation()};
  const Stretch stretch = standing_at(pose);
  const Vec3 point_C = random.normal_vector(1.0);
  EXPECT_LE((placed(stretch, point_C) - (pose.position + pose.orientation * point_C)).norm(),
            stretch.reach_m(point_C.norm()));
  EXPECT_LE(stretch.reach_m(1.0), 200.0 * kEpsilon * (1.0 + pose.position.norm()));
}

}  // namespace
}  // namespace camway::motion::test
