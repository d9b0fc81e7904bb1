// SPDX-License-Identifier: MIT
#include "daemon/motion/path/segment.h"

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

/// Evaluates by the power basis, independently of the implementation.
template <class Value, std::size_t N>
Value bernstein_sum(const std::array<Value, N>& points, double u) {
  Value sum = Value::Zero();
  for (std::size_t i = 0; i < N; ++i) {
    double choose = 1.0;
    for (std::size_t k = 1; k <= i; ++k)
      choose *= static_cast<double>(N - k) / static_cast<double>(k);
    sum += choose * std::pow(u, static_cast<double>(i)) *
           std::pow(1.0 - u, static_cast<double>(N - 1 - i)) * points[i];
  }
  return sum;
}

TEST(Segment, EvaluatesTheBernsteinSum) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const Segment segment = test::random_segment(random, 0.5);
    const double u = random.uniform(0.0, 1.0);
    // 10 times the size of the data: a few tens of roundings in either formula.
    EXPECT_LT((position_at(segment, u) - bernstein_sum(segment.position, u)).norm(),
              100.0 * kEpsilon * 10.0);
    EXPECT_LT((orientation_numerator_at(segment, u) - bernstein_sum(segment.orientation, u)).norm(),
              100.0 * kEpsilon * 3.0);
  }
}

TEST(Segment, MeetsItsEndsBitForBit) {
  Random random(12);
  const Segment segment = test::random_segment(random, 0.5);
  EXPECT_EQ(position_at(segment, 0.0), segment.position[0]);
  EXPECT_EQ(position_at(segment, 1.0), segment.position[3]);
  EXPECT_EQ(orientation_numerator_at(segment, 0.0), segment.orientation[0]);
  EXPECT_EQ(orientation_numerator_at(segment, 1.0), segment.orientation[6]);
  EXPECT_EQ(segment_time_s(segment, 0.0), segment.t0_s);
  EXPECT_EQ(segment_time_s(segment, 1.0), segment.t1_s);
}

TEST(Segment, ParameterIsClampedAndInvertsTime) {
  Random random(13);
  const Segment segment = test::random_segment(random, 0.5);
  EXPECT_EQ(segment_parameter(segment, segment.t0_s - 1.0), 0.0);
  EXPECT_EQ(segment_parameter(segment, segment.t1_s + 1.0), 1.0);
  const double rounding = 4.0 * kEpsilon *
                          std::max(std::abs(segment.t0_s), std::abs(segment.t1_s)) /
                          (segment.t1_s - segment.t0_s);
  for (double u = 0.0; u <= 1.0; u += 0.0625)
    EXPECT_NEAR(segment_parameter(segment, segment_time_s(segment, u)), u, rounding);
}

TEST(Segment, PoseHasUnitLength) {
  Random random(14);
  for (int i = 0; i < 300; ++i) {
    const Segment segment = test::random_segment(random, 0.9);
    EXPECT_NEAR(pose_at(segment, random.uniform(0.0, 1.0)).orientation.norm(), 1.0, 4.0 * kEpsilon);
  }
}

// Central differences over h have an error of h² times the second next derivative, plus rounding
// divided by h or h². The bound allows for both, for data of size 10 at h = 1e-4 of the parameter.
TEST(Segment, DerivativesAgreeWithDifferences) {
  Random random(15);
  for (int i = 0; i < 200; ++i) {
    const Segment segment = test::random_segment(random, 0.4);
    const double u = random.uniform(0.1, 0.9);
    constexpr double kStep = 1e-4;
    const double duration_s = segment.t1_s - segment.t0_s;
    const Pose before = pose_at(segment, u - kStep);
    const Pose at = pose_at(segment, u);
    const Pose after = pose_at(segment, u + kStep);
    const SegmentDerivatives derivatives = derivatives_at(segment, u);
    const double h_s = kStep * duration_s;
    const Vec3 velocity = (after.position - before.position) / (2.0 * h_s);
    const Vec3 acceleration = (after.position - 2.0 * at.position + before.position) / (h_s * h_s);
    const Vec4 q0 = geometry::wxyz(before.orientation);
    const Vec4 q1 = geometry::wxyz(at.orientation);
    const Vec4 q2 = geometry::wxyz(after.orientation);
    EXPECT_LT((derivatives.velocity_m_per_s - velocity).norm() * duration_s, 1e-5);
    EXPECT_LT((derivatives.acceleration_m_per_s2 - acceleration).norm() * duration_s * duration_s,
              1e-5);
    EXPECT_LT((derivatives.orientation_rate_per_s - (q2 - q0) / (2.0 * h_s)).norm() * duration_s,
              1e-4);
    EXPECT_LT(
        (derivatives.orientation_acceleration_per_s2 - (q2 - 2.0 * q1 + q0) / (h_s * h_s)).norm() *
            duration_s * duration_s,
        1e-3);
  }
}

TEST(SubSegment, IsTheSameMotion) {
  Random random(16);
  for (int i = 0; i < 300; ++i) {
    const Segment segment = test::random_segment(random, 0.5);
    double u0 = random.uniform(0.0, 1.0);
    double u1 = random.uniform(0.0, 1.0);
    if (u0 > u1) std::swap(u0, u1);
    const Segment part = sub_segment(segment, u0, u1);
    const double v = random.uniform(0.0, 1.0);
    const double u = u0 + v * (u1 - u0);
    EXPECT_LT((position_at(part, v) - position_at(segment, u)).norm(), 100.0 * kEpsilon * 10.0);
    EXPECT_LT((orientation_numerator_at(part, v) - orientation_numerator_at(segment, u)).norm(),
              100.0 * kEpsilon * 3.0);
  }
}

TEST(SubSegment, PartsShareTheirEndsBitForBit) {
  Random random(17);
  for (int i = 0; i < 100; ++i) {
    const Segment segment = test::random_segment(random, 0.5);
    const double u = random.uniform(0.2, 0.8);
    const Segment left = sub_segment(segment, 0.1, u);
    const Segment right = sub_segment(segment, u, 0.9);
    EXPECT_EQ(left.t1_s, right.t0_s);
    EXPECT_EQ(left.position[3], right.position[0]);
    EXPECT_EQ(left.orientation[6], right.orientation[0]);
    EXPECT_EQ(left.position[3], position_at(segment, u));
    EXPECT_EQ(left.orientation[6], orientation_numerator_at(segment, u));
  }
  const Segment segment = test::random_segment(random, 0.5);
  const Segment whole = sub_segment(segment, 0.0, 1.0);
  EXPECT_EQ(whole.position, segment.position);
  EXPECT_EQ(whole.orientation, segment.orientation);
}

TEST(OrientationWeight, IsBelowEverySample) {
  Random random(18);
  for (int i = 0; i < 200; ++i) {
    const Segment segment = test::random_segment(random, random.uniform(0.0, 2.0));
    const double least = smallest_orientation_weight(segment);
    double least_sampled = 1e300;
    for (int k = 0; k <= 100; ++k)
      least_sampled =
          std::min(least_sampled, orientation_numerator_at(segment, k / 100.0).squaredNorm());
    // Control points are shorter than 4.2; a dozen roundings.
    EXPECT_LE(least, least_sampled + 20.0 * kEpsilon * 18.0);
  }
}

TEST(OrientationWeight, DoesNotProveACurveThroughZero) {
  Segment segment;
  segment.t1_s = 1.0;
  segment.position.fill(Vec3::Zero());
  for (std::size_t i = 0; i < 7; ++i)
    segment.orientation[i] = Vec4(1.0 - static_cast<double>(i) / 3.0, 0.0, 0.0, 0.0);
  EXPECT_LE(smallest_orientation_weight(segment), 0.0);
}

TEST(OrientationWeight, ProvesAConstant) {
  Segment segment;
  segment.t1_s = 1.0;
  segment.position.fill(Vec3::Zero());
  segment.orientation.fill(Vec4(0.5, 0.5, -0.5, 0.5));
  EXPECT_EQ(smallest_orientation_weight(segment), 1.0);
}

}  // namespace
}  // namespace camway::motion
