// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/path_frame.h"

#include <numbers>

#include "daemon/motion/spline/bump.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/motion/random_motion.h"
#include "tests/motion/smooth_joins.h"

namespace camway::motion {
namespace {

using test::Vec3;
using test::Vec4;
using testing::Random;

// The contract of answers, in metres and radians.
constexpr double kSamePath = 1e-9;
/// How much farther than the edited keyframe its neighbourhood may turn; the long way round is
/// several radians.
constexpr double kOvershoot_rad = 0.6;

/// Given keyframes, and a path through them that bumps have changed in between.
struct Corrected {
  std::vector<Keyframe> given;
  CubicPath path;
};

/// Bumps that are zero at all keyframes.
BumpRow row_between(Random& random, double begin_s, double end_s) {
  const int bumps = random.integer(1, 6);
  BumpRow row{{begin_s, end_s, bumps + 3}, 2, {}};
  for (int i = 0; i < bumps; ++i)
    row.bumps.push_back({random.normal_vector(0.5), 0.1 * geometry::wxyz(random.rotation())});
  return row;
}

Corrected corrected(Random& random, double largest_turn_rad) {
  Corrected result;
  double time_s = random.uniform(-5.0, 5.0);
  geometry::Quat orientation = random.rotation();
  for (int i = random.integer(2, 7); i > 0; --i) {
    result.given.push_back({time_s, {random.normal_vector(3.0), orientation}});
    time_s += random.log_uniform(0.05, 3.0);
    orientation = orientation *
                  test::turned(random.normal_vector(1.0), random.uniform(0.0, largest_turn_rad));
  }
  result.path = interpolate_cubic(result.given);
  for (std::size_t i = 0; i + 1 < result.given.size(); ++i) {
    if (random.integer(0, 3) == 0) continue;
    const BumpRow row = row_between(random, result.given[i].time_s, result.given[i + 1].time_s);
    result.path = with_bumps(result.path, {&row, 1});
  }
  return result;
}

void expect_same(const CubicPath& path, const CubicPath& again) {
  const Path expected = path.path();
  const Path replanned = again.path();
  for (int i = 0; i <= 200; ++i) {
    const double time_s = path.begin_s() + (path.end_s() - path.begin_s()) * (i / 200.0);
    const Pose a = expected.pose(time_s);
    const Pose b = replanned.pose(time_s);
    EXPECT_LE((a.position - b.position).norm(), kSamePath);
    EXPECT_LE(test::rotation_angle_rad(a.orientation, b.orientation), kSamePath);
  }
}

TEST(PathFrame, KeyframesAndFrameGiveACorrectedPathAgain) {
  Random random(9101);
  for (int round = 0; round < 300; ++round) {
    const auto [given, path] = corrected(random, std::numbers::pi);
    const std::vector<Keyframe> keyframes = keyframes_of(path, given);
    ASSERT_EQ(keyframes.size(), path.pieces.size() + 1);
    expect_same(path, interpolate_cubic(keyframes, frame_of(path)));
  }
}

TEST(PathFrame, TheDifferenceOfControlPointsBoundsThatOfTheCurves) {
  Random random(9102);
  for (int round = 0; round < 100; ++round) {
    const auto [given, path] = corrected(random, 1.0);
    const CubicPath again = interpolate_cubic(keyframes_of(path, given), frame_of(path));
    const PathDifference difference = difference_of(path, again);
    EXPECT_LE(difference.position_m, kSamePath / 100.0);
    EXPECT_LE(difference.image, kSamePath / 100.0);
    CubicPath moved = again;
    moved.pieces.back().position[2].x() += 0.25;
    EXPECT_NEAR(difference_of(path, moved).position_m, 0.25, kSamePath);
    moved.pieces.back().position[2].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isinf(difference_of(path, moved).position_m));
    moved.pieces.pop_back();
    EXPECT_TRUE(std::isinf(difference_of(path, moved).image));
  }
}

TEST(PathFrame, GivenKeyframesStayAsGiven) {
  Random random(9103);
  for (int round = 0; round < 100; ++round) {
    auto [given, path] = corrected(random, 1.0);
    given.front().is_repaired = true;
    const std::vector<Keyframe> keyframes = keyframes_of(path, given);
    std::size_t next = 0;
    for (const Keyframe& keyframe : keyframes) {
      if (keyframe.origin == KeyframeOrigin::kInserted) continue;
      ASSERT_LT(next, given.size());
      EXPECT_EQ(keyframe.time_s, given[next].time_s);
      EXPECT_EQ(keyframe.pose.position, given[next].pose.position);
      EXPECT_EQ(keyframe.pose.orientation.coeffs(), given[next].pose.orientation.coeffs());
      EXPECT_EQ(keyframe.is_repaired, next == 0);
      ++next;
    }
    EXPECT_EQ(next, given.size());
  }
}

// At a whole turn from the reference, an orientation alone does not tell its image.
TEST(PathFrame, AWholeTurnComesBackAsItWas) {
  const geometry::Quat first = test::turned({1.0, -2.0, 0.5}, 1.0);
  std::vector<Keyframe> given;
  for (int i = 0; i <= 10; ++i) {
    const double angle_rad = std::numbers::pi / 4.0 * i;
    given.push_back(
        {1.0 * i, {{0.1 * i, 0, 0}, first * test::turned({0.3, 0.8, -0.5}, angle_rad)}});
  }
  CubicPath path = interpolate_cubic(given);
  const BumpRow row{{7.0, 8.0, 4}, 2, {{{0.1, 0.2, 0.0}, {0.02, 0.03, 0.0, 0.01}}}};
  path = with_bumps(path, {&row, 1});
  expect_same(path, interpolate_cubic(keyframes_of(path, given), frame_of(path)));
}

TEST(PathFrame, AnEditedKeyframeIsMetAndThePathStaysSmooth) {
  Random random(9104);
  for (int round = 0; round < 100; ++round) {
    const auto [given, path] = corrected(random, 1.0);
    std::vector<Keyframe> keyframes = keyframes_of(path, given);
    const auto at =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(keyframes.size()) - 1));
    keyframes[at].pose.position += random.normal_vector(0.1);
    keyframes[at].pose.orientation =
        keyframes[at].pose.orientation * test::turned(random.normal_vector(1.0), 0.05);
    // The sign of a quaternion means nothing, and answers keep those of requests.
    if (random.integer(0, 1) == 0) keyframes[at].pose.orientation.coeffs() *= -1.0;
    if (random.integer(0, 1) == 0) keyframes[at].image.setZero();
    const Path edited = interpolate_cubic(keyframes, frame_of(path)).path();
    const Pose met = edited.pose(keyframes[at].time_s);
    EXPECT_LE((met.position - keyframes[at].pose.position).norm(), kSamePath);
    EXPECT_LE(test::rotation_angle_rad(met.orientation, keyframes[at].pose.orientation), kSamePath);
    // Not the long way round: the image stays on its side.
    for (int i = 0; i <= 100; ++i) {
      const double time_s = std::lerp(path.begin_s(), path.end_s(), i / 100.0);
      EXPECT_LE(
          test::rotation_angle_rad(path.pose(time_s).orientation, edited.pose(time_s).orientation),
          0.05 + kOvershoot_rad);
    }
  }
}

TEST(PathFrame, AReferenceOfAnyLengthWillDo) {
  Random random(9105);
  const auto [given, path] = corrected(random, 1.0);
  PathFrame frame = frame_of(path);
  frame.reference *= 7.0;
  expect_same(path, interpolate_cubic(keyframes_of(path, given), frame));
}

}  // namespace
}  // namespace camway::motion
