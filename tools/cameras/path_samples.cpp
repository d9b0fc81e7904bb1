// SPDX-License-Identifier: MIT
#include "tools/cameras/path_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tools/cameras/frame_rate.h"

namespace camway::tools {
namespace {

/// Keys that are this much more than a frame apart are a frame apart: files round times to floats.
constexpr double kRoundedFrame = 0.01;
constexpr double kUsualRate = 24.0;
/// Most frames between the keys of a track: a camera that stands still for an hour at 60 frames a
/// second. Times of a damaged file may be centuries apart, each from the next.
constexpr double kMostFramesBetween = 216'000.0;

/// The steps from frame to frame between key `i` and the next one.
double steps_after(const CameraTrack& track, std::size_t i) {
  const double fps = track.fps.value_or(kUsualRate);
  const double length_s = track.keys[i + 1].time_s - track.keys[i].time_s;
  return std::min(kMostFramesBetween, std::ceil(length_s * fps - kRoundedFrame));
}

/// The most steps between two keys: only where there are too many in all, each has its share.
double most_steps(const CameraTrack& track) {
  const std::size_t gaps = track.keys.size() - 1;
  double sum = 0.0;
  for (std::size_t i = 0; i < gaps; ++i) sum += steps_after(track, i);
  if (sum <= kMostFramesBetween + static_cast<double>(gaps)) return kMostFramesBetween;
  return std::max(1.0, std::floor(kMostFramesBetween / static_cast<double>(gaps)));
}

/// Adds a key, whose orientation is on the side of the one before.
void add_pose(const motion::Path& path, double at_s, double time_s, CameraTrack& track) {
  motion::Pose pose = path.pose(at_s);
  if (!track.keys.empty() && pose.orientation.dot(track.keys.back().pose_W.orientation) < 0.0) {
    pose.orientation.coeffs() *= -1.0;
  }
  track.keys.push_back({time_s, pose, std::nullopt});
}

}  // namespace

double frame_count(const motion::Path& path, double fps) {
  return std::floor((path.end_s() - path.begin_s()) * fps + kOnFrame) + 1.0;
}

CameraTrack frames_of(const motion::Path& path, double fps, double begin_s) {
  CameraTrack track;
  track.fps = fps;
  const auto frames = static_cast<std::size_t>(frame_count(path, fps));
  track.keys.reserve(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    const double since_s = static_cast<double>(i) / fps;
    add_pose(path, std::min(path.begin_s() + since_s, path.end_s()), begin_s + since_s, track);
  }
  return track;
}

CameraTrack poses_at(const motion::Path& path, std::span<const double> times_s) {
  CameraTrack track;
  for (const double time_s : times_s) add_pose(path, time_s, time_s, track);
  return track;
}

CameraTrack with_frames_between(const CameraTrack& track) {
  if (!track.has_times || track.keys.empty()) return track;
  const double most = most_steps(track);
  CameraTrack result = track;
  result.keys.clear();
  result.tangents.clear();
  result.playback = Playback::kLinear;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    result.keys.push_back(track.keys[i]);
    if (i + 1 == track.keys.size()) break;
    const double begin_s = track.keys[i].time_s;
    const double end_s = track.keys[i + 1].time_s;
    const double steps = std::min(most, steps_after(track, i));
    for (double k = 1.0; k < steps; k += 1.0) {
      const double time_s = begin_s + k * (end_s - begin_s) / steps;
      if (!(time_s > result.keys.back().time_s && time_s < end_s)) continue;
      result.keys.push_back({time_s, pose_at(track, time_s), std::nullopt});
    }
  }
  return result;
}

}  // namespace camway::tools
