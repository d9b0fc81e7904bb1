// SPDX-License-Identifier: MIT
#include "daemon/paper/corner_curve.h"

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/bezier.h"
#include "tests/motion/random_motion.h"

namespace camway::paper {
namespace {

using motion::Corners;
using motion::Keyframe;
using motion::Path;
using motion::Pose;
using motion::Segment;
namespace bezier = motion::bezier;
namespace test = motion::test;
using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

Vec3 corner_at(const Segment& segment, const Vec3& corner_C, double u) {
  const Pose pose = pose_at(segment, u);
  return pose.orientation * corner_C + pose.position;
}

TEST(CornerCurve, IsTheMotionOfTheCorner) {
  Random random(101);
  for (int i = 0; i < 300; ++i) {
    const Segment segment = test::random_segment(random, 0.6);
    const Vec3 corner_C = random.normal_vector(0.5);
    const RationalCurve curve = corner_curve(segment, corner_C);
    for (int k = 0; k <= 20; ++k) {
      const double u = k / 20.0;
      // Weights are between 0.005 and 6; numerators about 10 times that.
      EXPECT_LT((curve.point_at(u) - corner_at(segment, corner_C, u)).norm(),
                1e4 * kEpsilon * 10.0);
    }
  }
}

TEST(CornerCurve, OfAnInterpolatedPathIsTheMotionOfTheCorner) {
  Random random(102);
  const Path path = interpolate(test::with_times(test::random_poses(random, 200)));
  const Corners corners_C = motion::near_corners_C({1.3, 1.0, 0.1});
  for (const Segment& segment : path.segments()) {
    for (const Vec3& corner_C : corners_C) {
      const RationalCurve curve = corner_curve(segment, corner_C);
      for (const double u : {0.0, 0.25, 0.7, 1.0})
        EXPECT_LT((curve.point_at(u) - corner_at(segment, corner_C, u)).norm(),
                  64.0 * kEpsilon * 15.0);
    }
  }
}

TEST(CornerCurve, WeightsAreTheSquaredLengthOfTheQuaternion) {
  Random random(103);
  const Segment segment = test::random_segment(random, 0.6);
  const RationalCurve curve = corner_curve(segment, Vec3(1, 2, 3));
  for (const double u : {0.0, 0.3, 1.0}) {
    const double expected = orientation_numerator_at(segment, u).squaredNorm();
    EXPECT_NEAR(bezier::value_at(curve.homogeneous, u)[3], expected, 32.0 * kEpsilon * expected);
  }
}

/// Evaluates the short-cut of 1995: the position is elevated as a polynomial to degree 12 and added
/// to the control points of the rational rotation, as if weights did not matter.
Vec3 short_cut_at(const Segment& segment, const Vec3& corner_C, double u) {
  const RationalCurve rotation = [&] {
    Segment turning = segment;
    turning.position.fill(Vec3::Zero());
    return corner_curve(turning, corner_C);
  }();
  const std::array<Vec3, 16> position = bezier::elevated<12>(segment.position);
  std::array<Vec4, 16> sum;
  for (std::size_t i = 0; i < 16; ++i) {
    const double weight = rotation.homogeneous[i][3];
    sum[i] << rotation.homogeneous[i].head<3>() + weight * position[i], weight;
  }
  const Vec4 value = bezier::value_at(sum, u);
  return value.head<3>() / value[3];
}

TEST(CornerCurve, DegreeTwelveWouldMissByACentimetre) {
  Random random(104);
  double largest_m = 0.0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const std::vector<Keyframe> keyframes = test::with_times(
        {{Vec3::Zero(), random.rotation()}, {random.normal_vector(1.0), random.rotation()}});
    const Path path = interpolate(keyframes);
    for (const Segment& segment : path.segments()) {
      for (int k = 0; k <= 20; ++k)
        largest_m = std::max(largest_m, (short_cut_at(segment, Vec3(0.1, 0.1, -0.1), k / 20.0) -
                                         corner_at(segment, Vec3(0.1, 0.1, -0.1), k / 20.0))
                                            .norm());
    }
  }
  std::printf("[  METRES  ] degree 12 misses by %.4f\n", largest_m);
  EXPECT_GT(largest_m, 0.01);
}

}  // namespace
}  // namespace camway::paper
