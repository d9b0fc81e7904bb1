// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/interpolate.h"

#include <numbers>

#include "tests/motion/random_motion.h"
#include "tests/motion/smooth_joins.h"
#include "tests/motion/spline/awkward_keyframes.h"
#include "tests/support/case_name.h"

namespace camway::motion {
namespace {

using geometry::Quat;
using test::expect_smooth;
using test::expect_smooth_join;
using test::kEpsilon;
using test::longest;
using test::Vec3;
using test::Vec4;
using testing::Random;

/// Bound on the error of orientations at keyframes, in radians: a dozen quaternion products, a root
/// and a division.
constexpr double kOrientationRounding_rad = 64.0 * kEpsilon;

class Interpolate : public ::testing::TestWithParam<test::AwkwardKeyframes> {};

INSTANTIATE_TEST_SUITE_P(Awkward, Interpolate, ::testing::ValuesIn(test::awkward_keyframes()),
                         testing::name_of_case);

void expect_keyframes_met(const Path& path, const std::vector<Keyframe>& keyframes) {
  EXPECT_EQ(path.begin_s(), keyframes.front().time_s);
  EXPECT_EQ(path.end_s(), keyframes.back().time_s);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Pose pose = path.pose(keyframes[i].time_s);
    EXPECT_EQ(pose.position, keyframes[i].pose.position) << "keyframe " << i;
    EXPECT_LE(test::rotation_angle_rad(pose.orientation, keyframes[i].pose.orientation),
              kOrientationRounding_rad)
        << "keyframe " << i;
  }
}

TEST_P(Interpolate, MeetsEveryKeyframe) {
  expect_keyframes_met(interpolate(GetParam().keyframes), GetParam().keyframes);
}

TEST_P(Interpolate, IsTwiceDifferentiableAtEveryJoin) {
  expect_smooth(interpolate(GetParam().keyframes));
}

TEST_P(Interpolate, OrientationHasUnitLengthEverywhere) {
  const Path path = interpolate(GetParam().keyframes);
  for (const Segment& segment : path.segments()) {
    for (int k = 0; k <= 8; ++k)
      ASSERT_NEAR(pose_at(segment, k / 8.0).orientation.norm(), 1.0, 4.0 * kEpsilon);
  }
}

/// The largest distance of two paths, at dense samples, with `undo` applied to the second.
struct Difference {
  double position_m = 0.0;
  double angle_rad = 0.0;
};
template <class Undo>
Difference difference(const Path& path, const Path& other, Undo undo) {
  Difference largest;
  const double span_s = path.end_s() - path.begin_s();
  const int samples = static_cast<int>(std::max<std::size_t>(500, 5 * path.segments().size()));
  for (int i = 0; i <= samples; ++i) {
    const double time_s = path.begin_s() + span_s * i / samples;
    const Pose expected = path.pose(time_s);
    const Pose pose = undo(other, time_s);
    largest.position_m = std::max(largest.position_m, (pose.position - expected.position).norm());
    largest.angle_rad = std::max(largest.angle_rad,
                                 test::rotation_angle_rad(pose.orientation, expected.orientation));
  }
  return largest;
}

// Rotated keyframes are rounded; so are mirrored times, and a time error is a motion at the fastest
// speed. Slopes divide by steps that may be `kShortestStep` = 1/100 of the mean, and the frame `r`
// has more rounding than its data: by exp(2) where it was searched for. Together less than this.
constexpr double kAmplification = 512.0;

void expect_only_rounding(const Difference& seen, const Path& path, double shift_m) {
  double speed_m_per_s = 0.0;
  double rate_rad_per_s = 0.0;
  double size_m = shift_m;
  for (const Segment& segment : path.segments()) {
    const SegmentDerivatives derivatives = derivatives_at(segment, 0.0);
    speed_m_per_s = std::max(speed_m_per_s, derivatives.velocity_m_per_s.norm());
    rate_rad_per_s = std::max(rate_rad_per_s, 2.0 * derivatives.orientation_rate_per_s.norm());
    size_m = std::max(size_m, longest(segment.position));
  }
  const double time_s = std::max(std::abs(path.begin_s()), std::abs(path.end_s()));
  EXPECT_LE(seen.position_m,
            kAmplification * kEpsilon * size_m + 4.0 * kEpsilon * time_s * speed_m_per_s);
  EXPECT_LE(seen.angle_rad, kAmplification * kEpsilon + 4.0 * kEpsilon * time_s * rate_rad_per_s);
}

Difference difference_after_moving_the_world(const std::vector<Keyframe>& keyframes,
                                             const Quat& rotation, const Vec3& shift) {
  std::vector<Keyframe> moved = keyframes;
  for (Keyframe& keyframe : moved) {
    keyframe.pose.position = rotation * keyframe.pose.position + shift;
    keyframe.pose.orientation = rotation * keyframe.pose.orientation;
  }
  return difference(interpolate(keyframes), interpolate(moved),
                    [&](const Path& other, double time_s) {
                      const Pose pose = other.pose(time_s);
                      return Pose{rotation.conjugate() * (pose.position - shift),
                                  rotation.conjugate() * pose.orientation};
                    });
}

TEST_P(Interpolate, IsTheSameMotionFromEveryWorldFrame) {
  Random random(61);
  const Path path = interpolate(GetParam().keyframes);
  for (int repeat = 0; repeat < 8; ++repeat) {
    const Vec3 shift = random.normal_vector(10.0);
    const Difference seen =
        difference_after_moving_the_world(GetParam().keyframes, random.rotation(), shift);
    expect_only_rounding(seen, path, shift.norm());
  }
}

TEST_P(Interpolate, SignsOfQuaternionsDoNotMatter) {
  Random random(62);
  const Path path = interpolate(GetParam().keyframes);
  for (int repeat = 0; repeat < 8; ++repeat) {
    std::vector<Keyframe> signs = GetParam().keyframes;
    for (Keyframe& keyframe : signs) {
      if (random.chance(0.5)) keyframe.pose.orientation.coeffs() *= -1.0;
    }
    const Difference seen =
        difference(path, interpolate(signs),
                   [](const Path& other, double time_s) { return other.pose(time_s); });
    expect_only_rounding(seen, path, 0.0);
  }
}

/// A half turn has a direction of its own, which reversal does not change.
class InterpolateReversible : public Interpolate {};

std::vector<test::AwkwardKeyframes> without_half_turns() {
  std::vector<test::AwkwardKeyframes> sets = test::awkward_keyframes();
  std::erase_if(sets, [](const test::AwkwardKeyframes& set) { return set.has_half_turns; });
  return sets;
}

INSTANTIATE_TEST_SUITE_P(Awkward, InterpolateReversible, ::testing::ValuesIn(without_half_turns()),
                         testing::name_of_case);

TEST_P(InterpolateReversible, ReversedKeyframesReverseTheMotion) {
  const Path path = interpolate(GetParam().keyframes);
  const double mirror_s = path.begin_s() + path.end_s();
  std::vector<Keyframe> reversed = GetParam().keyframes;
  std::ranges::reverse(reversed);
  for (Keyframe& keyframe : reversed) keyframe.time_s = mirror_s - keyframe.time_s;
  const Difference seen =
      difference(path, interpolate(reversed),
                 [&](const Path& other, double time_s) { return other.pose(mirror_s - time_s); });
  expect_only_rounding(seen, path, 0.0);
}

TEST_P(Interpolate, IsBitIdenticalWhenRepeated) {
  const Path first = interpolate(GetParam().keyframes);
  const Path second = interpolate(GetParam().keyframes);
  ASSERT_EQ(first.segments().size(), second.segments().size());
  for (std::size_t i = 0; i < first.segments().size(); ++i) {
    EXPECT_EQ(first.segments()[i].t0_s, second.segments()[i].t0_s);
    EXPECT_EQ(first.segments()[i].position, second.segments()[i].position);
    EXPECT_EQ(first.segments()[i].orientation, second.segments()[i].orientation);
  }
}

TEST(InterpolateRandom, HasAllPropertiesByTheThousand) {
  Random random(68);
  for (int i = 0; i < 3000 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(::testing::Message() << "set " << i);
    const std::vector<Keyframe> keyframes =
        test::with_times(test::random_poses(random, random.integer(2, 16)));
    const Path path = interpolate(keyframes);
    expect_keyframes_met(path, keyframes);
    expect_smooth(path);
    for (const Segment& segment : path.segments())
      EXPECT_GT(smallest_orientation_weight(segment), 0.0);
    if (i % 10 != 0) continue;
    const Vec3 shift = random.normal_vector(10.0);
    expect_only_rounding(difference_after_moving_the_world(keyframes, random.rotation(), shift),
                         path, shift.norm());
  }
}

TEST(InterpolateTwo, IsAStraightLineAtConstantSpeed) {
  Random random(63);
  const std::vector<Keyframe> keyframes = test::with_times(test::random_poses(random, 2));
  const Path path = interpolate(keyframes);
  const Vec3 from = keyframes[0].pose.position;
  const Vec3 to = keyframes[1].pose.position;
  for (int i = 0; i <= 100; ++i) {
    const double u = i / 100.0;
    const Vec3 expected = from + u * (to - from);
    EXPECT_LT((path.pose(u * keyframes[1].time_s).position - expected).norm(),
              32.0 * kEpsilon * test::size_m(keyframes));
  }
}

TEST(InterpolateTwo, TurnsAboutOneAxis) {
  Random random(64);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Quat start = random.rotation();
    const Vec3 axis = random.normal_vector(1.0).normalized();
    const double angle_rad = random.uniform(0.01, 3.14);
    const std::vector<Keyframe> keyframes = {
        {0.0, {Vec3::Zero(), start}, KeyframeOrigin::kGiven},
        {2.0, {Vec3::Zero(), start * test::turned(axis, angle_rad)}, KeyframeOrigin::kGiven}};
    const Path path = interpolate(keyframes);
    double turned_rad = 0.0;
    for (int i = 0; i <= 50; ++i) {
      const Quat turn = start.conjugate() * path.pose(2.0 * i / 50.0).orientation;
      EXPECT_LT(turn.vec().cross(axis).norm(), kOrientationRounding_rad);
      const double now_rad =
          2.0 * std::atan2(turn.vec().dot(axis) * (turn.w() < 0 ? -1.0 : 1.0), std::abs(turn.w()));
      EXPECT_GE(now_rad, turned_rad - kOrientationRounding_rad) << "never turns back";
      turned_rad = now_rad;
    }
    EXPECT_NEAR(turned_rad, angle_rad, kOrientationRounding_rad);
  }
}

// The natural end condition: the acceleration is zero at both ends, exactly by the control points.
TEST(Interpolate, PositionHasNaturalEnds) {
  Random random(65);
  const Path path = interpolate(test::with_times(test::random_poses(random, 9)));
  for (const SegmentDerivatives& end :
       {derivatives_at(path.segments().front(), 0.0), derivatives_at(path.segments().back(), 1.0)})
    EXPECT_LT(end.acceleration_m_per_s2.norm(), 1e3 * kEpsilon);
}

/// Returns the second derivative at `x` of the polynomial with these zeros, by differentiating its
/// factors.
double second_derivative_of_product(const std::vector<double>& zeros, double x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    for (std::size_t j = 0; j < zeros.size(); ++j) {
      if (i == j) continue;
      double product = 1.0;
      for (std::size_t k = 0; k < zeros.size(); ++k)
        if (k != i && k != j) product *= x - zeros[k];
      sum += product;
    }
  }
  return sum;
}

// An oracle for the whole position spline: of all interpolants, the natural one has the least
// bending energy. So adding any smooth function that vanishes at the keyframes must raise the
// integral of the squared acceleration, with either sign, and even if it is so small that its own
// energy is small against a first-order change.
TEST(Interpolate, PositionBendsLeast) {
  Random random(66);
  const std::vector<Keyframe> keyframes = test::with_times(test::random_poses(random, 6));
  const Path path = interpolate(keyframes);
  const double end_s = path.end_s();
  std::vector<double> zeros;
  for (const Keyframe& keyframe : keyframes) zeros.push_back(keyframe.time_s / end_s);
  constexpr int kSamples = 20'000;
  for (const Vec3& amplitude : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, -1, 1)}) {
    double mixed = 0.0;
    double own = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const double x = (k + 0.5) / kSamples;
      const Segment& segment = path.segments()[path.segment_index(x * end_s)];
      const Vec3 acceleration =
          derivatives_at(segment, segment_parameter(segment, x * end_s)).acceleration_m_per_s2;
      const double bump = second_derivative_of_product(zeros, x);
      mixed += acceleration.dot(amplitude) * bump / kSamples;
      own += amplitude.squaredNorm() * bump * bump / kSamples;
    }
    // The energy changes by ±2·h·mixed + h²·own. The midpoint rule on 20,000 samples has a relative
    // error of 1e-7.
    constexpr double kLittle = 1e-5;
    EXPECT_GT(kLittle * own, 2.0 * std::abs(mixed)) << amplitude.transpose();
  }
}

TEST(Interpolate, ALevelCameraStaysLevelForTenTurns) {
  for (const double step_deg : {10.0, 45.0, 90.0, 170.0}) {
    std::vector<Pose> poses;
    for (double angle_deg = 0.0; angle_deg <= 3600.0; angle_deg += step_deg) {
      const double angle_rad = angle_deg * std::numbers::pi / 180.0;
      poses.push_back({Vec3(2.0 * std::cos(angle_rad), 0.3 * angle_rad, std::sin(angle_rad)),
                       test::turned(Vec3::UnitY(), angle_rad)});
    }
    const Path path = interpolate(test::with_times(poses));
    double turned_rad = 0.0;
    Quat before = path.pose(0.0).orientation;
    for (int i = 0; i <= 5000; ++i) {
      const Quat q = path.pose(path.end_s() * i / 5000.0).orientation;
      ASSERT_LT((q * Vec3::UnitY() - Vec3::UnitY()).norm(), kOrientationRounding_rad);
      turned_rad += test::rotation_angle_rad(before, q);
      before = q;
    }
    const double last_deg = step_deg * static_cast<double>(poses.size() - 1);
    EXPECT_NEAR(turned_rad, last_deg * std::numbers::pi / 180.0, 1e-9) << "no swing to and fro";
  }
}

TEST(Interpolate, TenThousandKeyframesAreQuick) {
  Random random(67);
  const std::vector<Keyframe> keyframes = test::with_times(test::random_poses(random, 10'000));
  const Path path = interpolate(keyframes);
  EXPECT_GE(path.segments().size(), 9'999U);
  double least = 1e300;
  for (const Segment& segment : path.segments())
    least = std::min(least, smallest_orientation_weight(segment));
  EXPECT_GT(least, 0.0) << "the orientation is proved to be defined everywhere";
}

}  // namespace
}  // namespace camway::motion
