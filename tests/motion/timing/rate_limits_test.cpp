// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/rate_limits.h"

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using testing::Random;

/// Returns the largest factor over dense samples.
double sampled_stretch(const Segment& segment, const RateLimits& limits) {
  double factor = 0.0;
  for (int i = 0; i <= 2000; ++i)
    factor = std::max(factor, needed_slow_down(segment, i / 2000.0, limits));
  return factor;
}

Segment slower(Segment segment, double factor) {
  segment.t1_s = segment.t0_s + factor * (segment.t1_s - segment.t0_s);
  return segment;
}

/// Returns limits of one kind, or of all.
RateLimits random_limits(Random& random) {
  RateLimits limits;
  const int kind = random.integer(0, 3);
  if (kind == 0 || kind == 3) limits.speed_m_per_s = random.log_uniform(0.01, 100.0);
  if (kind == 1 || kind == 3) limits.acceleration_m_per_s2 = random.log_uniform(0.01, 100.0);
  if (kind == 2 || kind == 3) limits.turn_rate_rad_per_s = random.log_uniform(0.01, 100.0);
  return limits;
}

TEST(RateLimits, NoLimitIsAlwaysMet) {
  Random random(3101);
  EXPECT_FALSE(RateLimits{}.any());
  for (int round = 0; round < 50; ++round) {
    const Segment segment = test::random_segment(random, 0.4);
    EXPECT_TRUE(meets(segment, RateLimits{}));
    EXPECT_EQ(needed_slow_down(segment, 0.5, RateLimits{}), 0.0);
  }
}

// Samples 1/2000 apart miss the maximum of a smooth curve by less than a thousandth here.
TEST(RateLimits, AreMetExactlyWhereDenseSamplesSaySo) {
  Random random(3102);
  for (int round = 0; round < 400; ++round) {
    const Segment segment = test::random_segment(random, 0.4);
    const RateLimits limits = random_limits(random);
    ASSERT_TRUE(limits.any());
    const double factor = sampled_stretch(segment, limits);
    EXPECT_TRUE(meets(slower(segment, 1.001 * factor), limits)) << "round " << round;
    EXPECT_FALSE(meets(slower(segment, 0.999 * factor), limits)) << "round " << round;
    EXPECT_TRUE(meets(segment, scaled_limits(limits, 1.001 * factor))) << "round " << round;
    EXPECT_FALSE(meets(segment, scaled_limits(limits, 0.999 * factor))) << "round " << round;
  }
}

TEST(RateLimits, TheNeededStretchIsWhatMakesThePathSlowEnough) {
  Random random(3103);
  for (int round = 0; round < 100; ++round) {
    const Segment segment = test::random_segment(random, 0.4);
    const RateLimits limits = random_limits(random);
    const double u = random.uniform(0.0, 1.0);
    const Segment slowed = slower(segment, needed_slow_down(segment, u, limits));
    EXPECT_NEAR(needed_slow_down(slowed, u, limits), 1.0, 1e-12);
  }
}

TEST(RateLimits, OfAConstantMotionAreThoseRates) {
  const std::vector<Keyframe> keyframes = {
      {0.0, {geometry::Vec3::Zero(), geometry::Quat::Identity()}},
      {2.0, {geometry::Vec3(3, 0, 0), geometry::Quat::Identity()}}};
  const Path path = interpolate(keyframes);
  EXPECT_TRUE(meets(path, {1.5 * (1.0 + 1e-12), 1e-9, 1e-9}));
  EXPECT_FALSE(meets(path, {1.5 * (1.0 - 1e-12), 1e-9, 1e-9}));
}

}  // namespace
}  // namespace camway::motion
