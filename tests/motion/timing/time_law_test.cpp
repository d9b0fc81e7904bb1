// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/time_law.h"

#include "daemon/motion/path/bezier.h"
#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using geometry::Quat;
using test::Vec3;
using testing::Random;

double square(double value) { return value * value; }

Path random_segments(Random& random, int count) {
  return interpolate(test::with_times(test::random_poses(random, count)));
}

double largest_slow_down(const Path& path, const RateLimits& limits) {
  double factor = 0.0;
  for (const Segment& segment : path.segments()) {
    for (int i = 0; i <= 64; ++i)
      factor = std::max(factor, needed_slow_down(segment, i / 64.0, limits));
  }
  return factor;
}

/// Returns limits of random kinds, at least one of which the path breaks.
RateLimits biting_limits(Random& random, const Path& path) {
  RateLimits limits;
  do {
    limits = {};
    if (random.chance(0.5)) limits.speed_m_per_s = random.log_uniform(0.2, 5.0);
    if (random.chance(0.5)) limits.acceleration_m_per_s2 = random.log_uniform(0.05, 5.0);
    if (random.chance(0.5)) limits.turn_rate_rad_per_s = random.log_uniform(0.2, 5.0);
  } while (!(largest_slow_down(path, limits) > 1.05));
  return limits;
}

/// Squared rate and half of its derivative at the two ends of a piece, which is a parabola.
struct Ends {
  double x[2];
  double u[2];
};
Ends ends_of(const TimeLaw& law, std::size_t piece) {
  const double from_s = law.knots_s()[piece];
  const double step_s = law.knots_s()[piece + 1] - from_s;
  // Not at the ends themselves, where the adjacent parabola may be evaluated.
  const double a = square(law.rate(from_s + 0.25 * step_s));
  const double b = square(law.rate(from_s + 0.5 * step_s));
  const double c = square(law.rate(from_s + 0.75 * step_s));
  return {{3.0 * a - 3.0 * b + c, a - 3.0 * b + 3.0 * c},
          {(-10.0 * a + 16.0 * b - 6.0 * c) / (2.0 * step_s),
           (6.0 * a - 16.0 * b + 10.0 * c) / (2.0 * step_s)}};
}

TEST(TimeLaw, LeavesAPathThatMeetsItsLimitsAsItIs) {
  Random random(3201);
  for (int round = 0; round < 20; ++round) {
    const Path path = random_segments(random, 6);
    const double factor = largest_slow_down(path, {1.0, 1.0, 1.0});
    const TimeLaw law = TimeLaw::within(path, scaled_limits({1.0, 1.0, 1.0}, 1.05 * factor), 0.05);
    EXPECT_EQ(law.slow_down(), 1.0);
    EXPECT_EQ(law.knots_s().size(), path.segments().size() + 1);
    const double time_s = random.uniform(path.begin_s(), path.end_s());
    EXPECT_NEAR(law.new_time_s(time_s), time_s, 1e-12 * path.end_s());
    EXPECT_EQ(law.rate(time_s), 1.0);
  }
}

TEST(TimeLaw, OfAConstantSpeedIsConstant) {
  const std::vector<Keyframe> keyframes = {{1.0, {Vec3::Zero(), Quat::Identity()}},
                                           {3.0, {Vec3(3, 0, 0), Quat::Identity()}}};
  const TimeLaw law = TimeLaw::within(interpolate(keyframes), {.speed_m_per_s = 0.5}, 0.1);
  EXPECT_NEAR(law.slow_down(), 3.0, 1e-12);
  EXPECT_EQ(law.new_time_s(1.0), 1.0);
  EXPECT_NEAR(law.new_time_s(2.0), 4.0, 1e-12);
  EXPECT_NEAR(law.rate(2.7), 1.0 / 3.0, 1e-12);
}

// On a circle at constant speed V the acceleration is V²/r, and only the speed can change: to
// sqrt(a r). At its ends the spline is not a circle.
TEST(TimeLaw, OnACircleMeetsTheAccelerationThatPointsInwards) {
  constexpr double kRadius_m = 2.0;
  constexpr double kSpeed_m_per_s = 1.5;
  constexpr double kLimit_m_per_s2 = 0.4;
  std::vector<Keyframe> keyframes;
  for (int i = 0; i <= 80; ++i) {
    const double angle_rad = 0.05 * i;
    keyframes.push_back(
        {angle_rad * kRadius_m / kSpeed_m_per_s,
         {kRadius_m * Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.0), Quat::Identity()}});
  }
  const Path path = interpolate(keyframes);
  const TimeLaw law = TimeLaw::within(path, {.acceleration_m_per_s2 = kLimit_m_per_s2}, 0.01);
  const double expected = std::sqrt(kLimit_m_per_s2 * kRadius_m) / kSpeed_m_per_s;
  for (std::size_t i = 30; i <= 50; ++i)
    EXPECT_NEAR(law.rate(keyframes[i].time_s), expected, 2e-3 * expected);
}

// A camera flies straight on and pans in the middle. The pan has to be slow; before and after it
// the speed changes at the limit, dx/dt = 2a/V, which is a trapezoid in time.
TEST(TimeLaw, BrakesBeforeItHasToAndAcceleratesAfterwards) {
  constexpr double kSpeed_m_per_s = 2.0;
  const RateLimits limits{.acceleration_m_per_s2 = 0.5, .turn_rate_rad_per_s = 0.5};
  const geometry::Vec4 from(1, 0, 0, 0);
  const geometry::Vec4 to(std::cos(0.5), 0, std::sin(0.5), 0);  // turned by 1 rad
  const auto segment = [&](double t0_s, double t1_s, const geometry::Vec4& a,
                           const geometry::Vec4& b) {
    Segment result{t0_s, t1_s, {}, {}};
    for (std::size_t i = 0; i <= 3; ++i) {
      const double share = static_cast<double>(i) / 3.0;
      result.position[i] = Vec3(kSpeed_m_per_s * bezier::lerp(t0_s, t1_s, share), 0, 0);
    }
    for (std::size_t i = 0; i <= 6; ++i)
      result.orientation[i] = bezier::lerp(a, b, static_cast<double>(i) / 6.0);
    return result;
  };
  const Path path({segment(0, 4, from, from), segment(4, 5, from, to), segment(5, 9, to, to)});
  const double step_s = 0.004;
  const TimeLaw law = TimeLaw::within(path, limits, step_s);
  // The chord rotates fastest at its centre and slowest at its ends.
  const double at_pan = square(law.rate(4.0));
  EXPECT_NEAR(law.rate(4.5), 0.5 / (2.0 * 2.0 * std::tan(0.25)), 1e-3);
  for (const double before_s : {0.1, 0.5, 0.9, 1.2, 2.0, 3.5}) {
    const double expected = std::min(1.0, at_pan + 2.0 * 0.5 / kSpeed_m_per_s * before_s);
    EXPECT_NEAR(square(law.rate(4.0 - before_s)), expected, 2.0 * step_s) << before_s;
    EXPECT_NEAR(square(law.rate(5.0 + before_s)), expected, 2.0 * step_s) << before_s;
  }
  EXPECT_EQ(law.rate(1.0), 1.0);
}

TEST(TimeLaw, MeetsAllLimitsAtItsKnots) {
  Random random(3202);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(::testing::Message() << "round " << round);
    const Path path = random_segments(random, random.integer(2, 8));
    const RateLimits limits = biting_limits(random, path);
    const TimeLaw law = TimeLaw::within(path, limits, random.log_uniform(0.02, 1.0));
    for (std::size_t i = 0; i + 1 < law.knots_s().size(); ++i) {
      const Ends ends = ends_of(law, i);
      for (const std::size_t end : {0U, 1U}) {
        const double knot_s = law.knots_s()[i + end];
        const Segment& segment = path.segments()[path.segment_index(knot_s)];
        const SegmentDerivatives at = derivatives_at(segment, segment_parameter(segment, knot_s));
        const double x = ends.x[end];
        // The rounding of the differences above.
        const double rounding =
            1e-12 * (1.0 + at.velocity_m_per_s.norm() / (law.knots_s()[i + 1] - law.knots_s()[i]));
        EXPECT_LE(x, 1.0 + 1e-12);
        EXPECT_LE(at.velocity_m_per_s.norm() * std::sqrt(x), limits.speed_m_per_s + rounding);
        EXPECT_LE(2.0 * at.orientation_rate_per_s.norm() * std::sqrt(x),
                  limits.turn_rate_rad_per_s + 1e-9);
        EXPECT_LE((at.acceleration_m_per_s2 * x + at.velocity_m_per_s * ends.u[end]).norm(),
                  limits.acceleration_m_per_s2 + rounding);
      }
    }
  }
}

TEST(TimeLaw, IsSmoothNeverFasterAndNoLongerThanStretchingAllTimesAlike) {
  Random random(3203);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(::testing::Message() << "round " << round);
    const Path path = random_segments(random, random.integer(2, 8));
    const RateLimits limits = biting_limits(random, path);
    const TimeLaw law = TimeLaw::within(path, limits, random.log_uniform(0.02, 1.0));
    EXPECT_GE(law.slow_down(), 1.0);
    EXPECT_LE(law.slow_down(), largest_slow_down(path, limits) * (1.0 + 1e-3));
    EXPECT_EQ(law.new_time_s(path.begin_s()), path.begin_s());
    double given_s = path.begin_s();
    double new_s = given_s;
    for (int i = 1; i <= 300; ++i) {
      const double next_s = bezier::lerp(path.begin_s(), path.end_s(), i / 300.0);
      const double next_new_s = law.new_time_s(next_s);
      EXPECT_GE(next_new_s - new_s, (next_s - given_s) * (1.0 - 1e-9));
      EXPECT_LE(law.rate(next_s), 1.0);
      EXPECT_GT(law.rate(next_s), 0.0);
      given_s = next_s;
      new_s = next_new_s;
    }
    for (std::size_t i = 0; i + 2 < law.knots_s().size(); ++i) {
      const Ends left = ends_of(law, i);
      const Ends right = ends_of(law, i + 1);
      EXPECT_EQ(law.new_time_s(law.knots_s()[i]), law.new_knots_s()[i]);
      EXPECT_NEAR(left.x[1], right.x[0], 1e-12);
      const double step_s = std::min(law.knots_s()[i + 1] - law.knots_s()[i],
                                     law.knots_s()[i + 2] - law.knots_s()[i + 1]);
      EXPECT_NEAR(left.u[1], right.u[0], 1e-12 / step_s);
    }
  }
}

// New time is the integral of given time over the rate.
TEST(TimeLaw, NewTimesBelongToTheRate) {
  Random random(3204);
  for (int round = 0; round < 20; ++round) {
    const Path path = random_segments(random, 5);
    const TimeLaw law = TimeLaw::within(path, biting_limits(random, path), 0.05);
    constexpr int kSteps = 20000;
    double sum_s = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double share = (i + 0.5) / kSteps;
      sum_s += (path.end_s() - path.begin_s()) / kSteps /
               law.rate(bezier::lerp(path.begin_s(), path.end_s(), share));
    }
    EXPECT_NEAR(law.new_knots_s().back() - law.new_knots_s().front(), sum_s, 1e-5 * sum_s);
  }
}

TEST(TimeLaw, ConvergesToTheFastest) {
  Random random(3205);
  for (int round = 0; round < 10; ++round) {
    const Path path = random_segments(random, 5);
    const RateLimits limits = biting_limits(random, path);
    const double coarse = TimeLaw::within(path, limits, 0.08).slow_down();
    const double middle = TimeLaw::within(path, limits, 0.02).slow_down();
    const double fine = TimeLaw::within(path, limits, 0.005).slow_down();
    EXPECT_LE(middle, coarse * 1.001);
    EXPECT_LE(fine, middle * 1.001);
    EXPECT_LT(middle - fine, 0.03 * fine);
  }
}

TEST(TimeLaw, AlikeStretchesAllTimes) {
  const TimeLaw law = TimeLaw::uniform({2.0, 6.0}, 1.5);
  EXPECT_NEAR(law.slow_down(), 1.5, 1e-14);
  EXPECT_EQ(law.new_time_s(2.0), 2.0);
  EXPECT_NEAR(law.new_time_s(3.0), 3.5, 1e-14);
  EXPECT_EQ(law.new_time_s(6.0), law.new_knots_s().back());
}

}  // namespace
}  // namespace camway::motion
