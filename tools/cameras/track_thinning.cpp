// SPDX-License-Identifier: MIT
#include "tools/cameras/track_thinning.h"

#include <algorithm>
#include <utility>

#include "daemon/motion/spline/interpolate.h"

namespace camway::tools {
namespace {

struct Difference {
  double position_m = 0.0;
  double turn_rad = 0.0;
};

motion::Path path_through(const CameraTrack& track, const std::vector<std::size_t>& kept) {
  std::vector<motion::Keyframe> keyframes;
  for (const std::size_t i : kept) {
    motion::Keyframe keyframe;
    keyframe.time_s = track.keys[i].time_s;
    keyframe.pose = track.keys[i].pose_W;
    keyframes.push_back(keyframe);
  }
  return motion::interpolate(keyframes);
}

Difference difference(const motion::Path& path, const TrackKey& key) {
  const motion::Pose pose = path.pose(key.time_s);
  return {(pose.position - key.pose_W.position).norm(),
          pose.orientation.angularDistance(key.pose_W.orientation)};
}

/// The key between two that differs most, in tolerances; the first one if none is between them.
std::pair<double, std::size_t> worst_between(const CameraTrack& track, const motion::Path& path,
                                             std::size_t first, std::size_t last,
                                             const ThinningTolerance& tolerance) {
  std::pair<double, std::size_t> worst = {0.0, first};
  for (std::size_t i = first + 1; i < last; ++i) {
    const Difference found = difference(path, track.keys[i]);
    const double tolerances =
        std::max(found.position_m / tolerance.position_m, found.turn_rad / tolerance.turn_rad);
    if (tolerances > worst.first) worst = {tolerances, i};
  }
  return worst;
}

ThinnedTrack measured(const CameraTrack& track, std::vector<std::size_t> kept) {
  const motion::Path path = path_through(track, kept);
  ThinnedTrack result{std::move(kept), 0.0, 0.0};
  for (const TrackKey& key : track.keys) {
    const Difference found = difference(path, key);
    result.largest_position_m = std::max(result.largest_position_m, found.position_m);
    result.largest_turn_rad = std::max(result.largest_turn_rad, found.turn_rad);
  }
  return result;
}

}  // namespace

ThinnedTrack thinned(const CameraTrack& track, const ThinningTolerance& tolerance) {
  std::vector<std::size_t> kept = {0, track.keys.size() - 1};
  for (bool is_within = false; !is_within;) {
    const motion::Path path = path_through(track, kept);
    std::vector<std::size_t> next = {0};
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
      const auto [tolerances, key] = worst_between(track, path, kept[i], kept[i + 1], tolerance);
      if (tolerances > 1.0) next.push_back(key);
      next.push_back(kept[i + 1]);
    }
    is_within = next.size() == kept.size();
    kept = std::move(next);
  }
  return measured(track, std::move(kept));
}

ThinnedTrack every(const CameraTrack& track, std::size_t step) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i + 1 < track.keys.size(); i += step) kept.push_back(i);
  kept.push_back(track.keys.size() - 1);
  return measured(track, std::move(kept));
}

}  // namespace camway::tools
