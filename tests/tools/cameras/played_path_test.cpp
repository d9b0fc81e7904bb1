// SPDX-License-Identifier: MIT
#include "tools/cameras/played_path.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/planning/result/path_faults.h"
#include "tests/tools/cameras/random_track.h"

namespace camway::tools {
namespace {

using testing::Random;

constexpr std::uint64_t kPlayedSeed = 20260601;
/// Rounding of a position of up to 20 m: some hundred units in the last place, 2^-52 * 20 m, for
/// the terms of a Bézier curve.
constexpr double kRounding_m = 1e-11;
/// Eigen takes the angle between quaternions from their difference: it is exact to the square root
/// of the rounding of a unit quaternion.
constexpr double kAngleRounding_rad = 1e-7;

/// Compares what is played with its path at many times, and returns the largest difference of the
/// orientation as a share of the bound.
double compare(const CameraTrack& track, Random& random) {
  const PlayedPath played = played_path(track);
  EXPECT_EQ(planning::find_fault(played.path.segments()), std::nullopt);
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double time_s = random.uniform(track.keys.front().time_s, track.keys.back().time_s);
    const motion::Pose expected = pose_at(track, time_s);
    const motion::Pose pose = played.path.pose(time_s);
    EXPECT_LT((pose.position - expected.position).norm(), kRounding_m);
    const double turn_rad = pose.orientation.angularDistance(expected.orientation);
    EXPECT_LE(turn_rad, played.turn_error_rad + kAngleRounding_rad);
    largest = std::max(largest, turn_rad);
  }
  return played.turn_error_rad > 0.0 ? largest / played.turn_error_rad : 0.0;
}

TEST(PlayedPath, IsWhatALinearTrackPlays) {
  Random random(kPlayedSeed);
  for (int trial = 0; trial < 50; ++trial) {
    compare(random_track(random, 8, 0.25, 3.0), random);
  }
}

TEST(PlayedPath, HasABoundOfItsTurnThatIsNotFarOff) {
  // One piece of the largest angle: a turn of twice that.
  Random random(kPlayedSeed);
  double largest = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    CameraTrack track = random_track(random, 2, 1.0, 0.0);
    const Eigen::AngleAxisd turn(2.0 * kLargestPieceAngle_rad, random.direction());
    track.keys[1].pose_W.orientation = geometry::Quat(turn * track.keys[0].pose_W.orientation);
    largest = std::max(largest, compare(track, random));
  }
  EXPECT_GT(largest, 0.5);
  EXPECT_LE(largest, 1.0);
}

TEST(PlayedPath, IsWhatABlendPlays) {
  Random random(kPlayedSeed);
  for (int trial = 0; trial < 50; ++trial) {
    // Quaternions on the other side are blended as they are, the longer way. At 1.4 radians apart
    // four-vectors on either side do not vanish between.
    CameraTrack track = random_track(random, 8, 0.25, 1.4);
    track.playback = Playback::kBlend;
    compare(track, random);
    EXPECT_EQ(played_path(track).turn_error_rad, 0.0);
  }
}

TEST(PlayedPath, IsWhatACubicTrackPlays) {
  Random random(kPlayedSeed);
  for (int trial = 0; trial < 50; ++trial) {
    CameraTrack track = random_track(random, 5, 1.5, 1.0);
    track.playback = Playback::kCubic;
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      KeyTangents tangents;
      tangents.position_in_m_per_s = random.in_cube(5.0);
      tangents.position_out_m_per_s = random.in_cube(5.0);
      tangents.orientation_in_per_s << random.in_cube(0.1), random.uniform(-0.1, 0.1);
      tangents.orientation_out_per_s << random.in_cube(0.1), random.uniform(-0.1, 0.1);
      track.tangents.push_back(tangents);
      // A cubic curve does not choose the nearer quaternion.
      auto& q = track.keys[i].pose_W.orientation;
      if (i > 0 && q.dot(track.keys[i - 1].pose_W.orientation) < 0.0) q.coeffs() *= -1.0;
    }
    compare(track, random);
    EXPECT_EQ(played_path(track).turn_error_rad, 0.0);
  }
}

}  // namespace
}  // namespace camway::tools
