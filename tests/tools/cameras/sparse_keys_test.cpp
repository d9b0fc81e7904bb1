// SPDX-License-Identifier: MIT
#include "tools/cameras/sparse_keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "tests/tools/cameras/random_track.h"
#include "tools/cameras/played_path.h"

namespace camway::tools {
namespace {

using testing::Random;

constexpr std::uint64_t kSparseSeed = 20261126;
constexpr double kSparseFps = 24.0;

/// A smooth path through random keyframes, each turned by up to `turn_rad` from the one before.
motion::Path random_path(Random& random, double turn_rad) {
  std::vector<motion::Keyframe> keyframes;
  for (const TrackKey& key : random_track(random, 6, 1.5, turn_rad).keys) {
    motion::Keyframe keyframe;
    keyframe.time_s = key.time_s;
    keyframe.pose = key.pose_W;
    keyframes.push_back(keyframe);
  }
  return motion::interpolate(keyframes);
}

TEST(SparseKeys, StayWithinTheToleranceWithFewKeys) {
  Random random(kSparseSeed);
  for (int trial = 0; trial < 10; ++trial) {
    const motion::Path path = random_path(random, 2.5);
    SparseKeys keys(path, kSparseFps);
    const ThinningTolerance tolerance;
    keys.keep_within(tolerance);
    const CameraTrack track = keys.track();
    EXPECT_EQ(fault_of(track), "");
    EXPECT_LT(track.keys.size(), 60U) << "of 181 frames";
    for (int i = 0; i < 2000; ++i) {
      const double time_s = random.uniform(path.begin_s(), path.end_s());
      const motion::Pose pose = path.pose(time_s);
      const motion::Pose played = pose_at(track, time_s);
      // Between candidates the error may be a little above that at the nearest ones.
      EXPECT_LT((pose.position - played.position).norm(), 1.1 * tolerance.position_m);
      EXPECT_LT(pose.orientation.angularDistance(played.orientation), 1.1 * tolerance.turn_rad);
    }
    const SparseKeys::Difference off = keys.difference(track, 0.0);
    EXPECT_LE(off.position_m, tolerance.position_m);
    EXPECT_LE(off.turn_rad, tolerance.turn_rad);
    EXPECT_GT(off.turn_rad, 0.1 * tolerance.turn_rad);
  }
}

TEST(SparseKeys, LieOnFramesWhereTheseSuffice) {
  Random random(kSparseSeed);
  for (int trial = 0; trial < 5; ++trial) {
    motion::Path path = random_path(random, 1.0);
    // The keyframes of this path are at 36 frames of the usual rate, which are none of this one.
    constexpr double kOtherFps = 25.0;
    SparseKeys between(path, kOtherFps);
    between.keep_within({});
    EXPECT_FALSE(between.are_on_frames());
    SparseKeys keys(path, kOtherFps);
    const ThinningTolerance tolerance;
    if (!keys.keep_frames_within(tolerance)) {
      ADD_FAILURE() << "frames do not suffice in trial " << trial;
      continue;
    }
    const CameraTrack track = keys.track();
    for (const TrackKey& key : track.keys) {
      EXPECT_NEAR(key.time_s * kOtherFps, std::round(key.time_s * kOtherFps), 0.02);
    }
    EXPECT_TRUE(keys.are_on_frames());
    // The path ends between two frames.
    EXPECT_NEAR(track.keys.back().time_s, 187.0 / kOtherFps, 1e-9);
    const SparseKeys::Difference off = keys.difference(track, 0.0);
    EXPECT_LE(off.position_m, tolerance.position_m);
    EXPECT_LE(off.turn_rad, tolerance.turn_rad);
    keys.add_near(2.0, 2.5);
    EXPECT_GT(keys.track().keys.size(), track.keys.size());
    // Nothing is near enough for this, so the keys stay what they were.
    const std::size_t before = between.track().keys.size();
    EXPECT_FALSE(between.keep_frames_within({1e-12, 1e-12}));
    EXPECT_EQ(between.track().keys.size(), before);
  }
}

TEST(SparseKeys, AreThePathItselfWhereItIsCubic) {
  Random random(kSparseSeed);
  const motion::Path path = random_path(random, 0.0);  // does not turn
  SparseKeys keys(path, kSparseFps);
  keys.keep_within({1e-9, 1e-6});
  // One key for each join, as the spline is cubic between them.
  EXPECT_LE(keys.track().keys.size(), path.segments().size() + 1);
}

TEST(SparseKeys, HaveTheDerivativesOfThePath) {
  Random random(kSparseSeed);
  const motion::Path path = random_path(random, 1.0);
  SparseKeys keys(path, kSparseFps);
  keys.keep_within({1e-4, 1e-4});
  const CameraTrack track = keys.track();
  constexpr double kStep_s = 1e-5;
  for (std::size_t i = 0; i + 1 < track.keys.size(); ++i) {
    const double time_s = track.keys[i].time_s;
    const geometry::Vec3 velocity =
        (path.pose(time_s + kStep_s).position - path.pose(time_s).position) / kStep_s;
    EXPECT_LT((track.tangents[i].position_out_m_per_s - velocity).norm(), 0.01);
    const auto q = [&](double at_s) {
      const geometry::Vec4 here = geometry::wxyz(track.keys[i].pose_W.orientation);
      const geometry::Vec4 there = geometry::wxyz(path.pose(at_s).orientation);
      return geometry::Vec4(there.dot(here) < 0.0 ? -there : there);
    };
    const geometry::Vec4 rate = (q(time_s + kStep_s) - q(time_s)) / kStep_s;
    EXPECT_LT((track.tangents[i].orientation_out_per_s - rate).norm(), 0.01);
  }
}

/// Both quaternions of an orientation are the same motion, in each segment.
TEST(SparseKeys, DoNotDependOnTheSideOfTheSphere) {
  Random random(kSparseSeed);
  const motion::Path path = random_path(random, 2.0);
  std::vector<motion::Segment> segments(path.segments().begin(), path.segments().end());
  for (std::size_t i = 1; i < segments.size(); i += 2) {
    for (geometry::Vec4& point : segments[i].orientation) point = -point;
  }
  SparseKeys keys(path, kSparseFps);
  SparseKeys turned(motion::Path(segments), kSparseFps);
  keys.keep_within({1e-3, 1e-3});
  turned.keep_within({1e-3, 1e-3});
  const CameraTrack expected = keys.track();
  const CameraTrack track = turned.track();
  ASSERT_EQ(track.keys.size(), expected.keys.size());
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    EXPECT_EQ(track.keys[i].pose_W.orientation.coeffs(),
              expected.keys[i].pose_W.orientation.coeffs());
    EXPECT_EQ(track.tangents[i].orientation_in_per_s, expected.tangents[i].orientation_in_per_s);
    EXPECT_EQ(track.tangents[i].orientation_out_per_s, expected.tangents[i].orientation_out_per_s);
  }
}

/// A turn by 540 degrees in three keyframes is a turn by 540 degrees with sparse keys, too.
TEST(SparseKeys, KeepTurnsOfAnySize) {
  std::vector<motion::Keyframe> keyframes;
  for (int i = 0; i <= 6; ++i) {
    motion::Keyframe keyframe;
    keyframe.time_s = i;
    keyframe.pose.position = geometry::Vec3(i, 0, 0);
    keyframe.pose.orientation =
        geometry::Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi * i, geometry::Vec3::UnitY()));
    if (i % 2 == 1) keyframe.pose.orientation.coeffs() *= -1.0;
    keyframes.push_back(keyframe);
  }
  const motion::Path path = motion::interpolate(keyframes);
  SparseKeys keys(path, kSparseFps);
  keys.keep_within({});
  const CameraTrack track = keys.track();
  double turned_rad = 0.0;
  for (int i = 0; i < 600; ++i) {
    turned_rad += pose_at(track, 0.01 * i)
                      .orientation.angularDistance(pose_at(track, 0.01 * (i + 1)).orientation);
  }
  EXPECT_NEAR(turned_rad, 3.0 * std::numbers::pi, 0.05);
}

TEST(SparseKeys, AreAddedNearAStretch) {
  Random random(kSparseSeed);
  SparseKeys keys(random_path(random, 0.0), kSparseFps);
  keys.keep_within({100.0, 3.0});
  ASSERT_EQ(keys.track().keys.size(), 2U);
  EXPECT_TRUE(keys.add_near(1.0, 1.0));
  EXPECT_TRUE(keys.add_near(1.0, 1.0));
  ASSERT_EQ(keys.track().keys.size(), 4U);
  EXPECT_LT(keys.track().keys[1].time_s, 2.0);
  EXPECT_FALSE(keys.add_near(100.0, 101.0));
  for (int i = 0; i < 30; ++i) keys.add_near(1.0, 1.0);
  EXPECT_FALSE(keys.add_near(1.001, 1.002)) << "each candidate there is a key already";
}

}  // namespace
}  // namespace camway::tools
