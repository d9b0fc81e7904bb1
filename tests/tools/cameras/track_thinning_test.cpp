// SPDX-License-Identifier: MIT
#include "tools/cameras/track_thinning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/motion/spline/interpolate.h"
#include "tests/tools/cameras/random_track.h"
#include "tools/cameras/path_samples.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using testing::Random;

constexpr std::uint64_t kThinningSeed = 20260602;

/// The poses of a smooth path through random keyframes.
CameraTrack smooth_track(Random& random) {
  const CameraTrack rough = random_track(random, 6, 2.0, 2.0);
  std::vector<motion::Keyframe> keyframes;
  for (const TrackKey& key : rough.keys) {
    motion::Keyframe keyframe;
    keyframe.time_s = key.time_s;
    keyframe.pose = key.pose_W;
    keyframes.push_back(keyframe);
  }
  return frames_of(motion::interpolate(keyframes), 24.0);
}

TEST(TrackThinning, KeepsThePathWithinTheTolerance) {
  Random random(kThinningSeed);
  for (int trial = 0; trial < 20; ++trial) {
    const CameraTrack track = smooth_track(random);
    const ThinnedTrack kept = thinned(track, {0.01, 0.01});
    EXPECT_LT(kept.kept.size(), track.keys.size() / 2) << trial;
    EXPECT_LE(kept.largest_position_m, 0.01);
    EXPECT_LE(kept.largest_turn_rad, 0.01);
    std::vector<motion::Keyframe> keyframes;
    for (const std::size_t i : kept.kept) {
      keyframes.emplace_back();
      keyframes.back().time_s = track.keys[i].time_s;
      keyframes.back().pose = track.keys[i].pose_W;
    }
    const motion::Path path = motion::interpolate(keyframes);
    for (const TrackKey& key : track.keys) {
      const motion::Pose pose = path.pose(key.time_s);
      ASSERT_LE((pose.position - key.pose_W.position).norm(), 0.01);
      ASSERT_LE(pose.orientation.angularDistance(key.pose_W.orientation), 0.01);
    }
  }
}

TEST(TrackThinning, NeedsTwoKeysOnALine) {
  CameraTrack track;
  for (int i = 0; i <= 10; ++i) {
    track.keys.push_back({0.1 * i, {geometry::Vec3(i, 0, 0), geometry::Quat::Identity()}, {}});
  }
  EXPECT_THAT(thinned(track, {}).kept, ElementsAre(0, 10));
}

TEST(TrackThinning, KeepsAllOfWhatIsNoPath) {
  Random random(kThinningSeed);
  const CameraTrack track = random_track(random, 40, 0.04, 3.0);
  EXPECT_EQ(thinned(track, {1e-6, 1e-6}).kept.size(), 40U);
}

TEST(TrackThinning, CountsFromTheFirstAndKeepsTheLast) {
  Random random(kThinningSeed);
  const CameraTrack track = random_track(random, 8, 1.0, 0.5);
  EXPECT_THAT(every(track, 3).kept, ElementsAre(0, 3, 6, 7));
  EXPECT_THAT(every(track, 1).kept, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(every(track, 100).kept, ElementsAre(0, 7));
  EXPECT_NEAR(every(track, 1).largest_position_m, 0.0, 1e-12);
  EXPECT_GT(every(track, 3).largest_position_m, 1.0);
}

TEST(PathSamples, EndWithTheLastFrameThatIsNotAfterThePath) {
  Random random(kThinningSeed);
  const CameraTrack track = random_track(random, 2, 1.01, 1.0);
  const std::vector<motion::Keyframe> keyframes = [&] {
    std::vector<motion::Keyframe> list(2);
    for (std::size_t i = 0; i < 2; ++i) {
      list[i].time_s = 100.0 + track.keys[i].time_s;
      list[i].pose = track.keys[i].pose_W;
    }
    return list;
  }();
  const motion::Path path = motion::interpolate(keyframes);
  const CameraTrack frames = frames_of(path, 25.0);
  ASSERT_EQ(frames.keys.size(), 26U);
  EXPECT_EQ(frames.keys.front().time_s, 0.0);
  EXPECT_EQ(frames.keys.back().time_s, 1.0);
  EXPECT_EQ(frames.keys[10].pose_W.position, path.pose(100.0 + 10.0 / 25.0).position);
  for (std::size_t i = 1; i < frames.keys.size(); ++i) {
    EXPECT_GE(frames.keys[i].pose_W.orientation.dot(frames.keys[i - 1].pose_W.orientation), 0.0);
  }
}

TEST(PathSamples, PutFramesBetweenKeysThatAreFarApart) {
  CameraTrack track;
  track.fps = 10.0;
  // The second step is a frame, but for the rounding of single precision.
  for (const double time_s : {0.0, 0.35, static_cast<double>(0.45F)}) {
    track.keys.push_back({time_s, {geometry::Vec3(time_s, 0, 0), geometry::Quat::Identity()}, {}});
  }
  const CameraTrack dense = with_frames_between(track);
  ASSERT_EQ(dense.keys.size(), 6U);
  EXPECT_NEAR(dense.keys[1].time_s, 0.0875, 1e-12);
  EXPECT_NEAR(dense.keys[1].pose_W.position.x(), 0.0875, 1e-12);
  track.has_times = false;
  EXPECT_EQ(with_frames_between(track).keys.size(), 3U);
}

TEST(FramesBetween, AreBoundedWhereTimesAreCenturiesApart) {
  CameraTrack track;
  track.has_times = true;
  for (int i = 0; i < 3000; ++i) {
    // Two seconds from one key to the next, and now and then a gap that no camera films.
    track.keys.push_back({2.0 * i + 1e12 * (i / 10), motion::Pose{}, std::nullopt});
  }
  const CameraTrack dense = with_frames_between(track);
  EXPECT_LE(dense.keys.size(), 216'000U + track.keys.size());
  EXPECT_GE(dense.keys.size(), 2700U * 48U) << "ordinary gaps keep their frames";
}

}  // namespace
}  // namespace camway::tools
