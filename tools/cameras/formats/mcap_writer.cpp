// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/cameras/files/mcap_file.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/foxglove.h"
#include "tools/cameras/formats/mcap_formats.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

constexpr double kMcapTicksPerSecond = 1e9;
/// Later times do not fit into 63 bits of nanoseconds, so they count from 0.
constexpr double kLatestTime_s = 9.2e9;

std::vector<motion::Pose> poses_of(const std::vector<TrackKey>& keys) {
  std::vector<motion::Pose> poses;
  for (const TrackKey& key : keys) poses.push_back(key.pose_W);
  return poses;
}

std::string calibration_message(const CameraWriteOptions& options, std::uint64_t time_ns) {
  const double width = options.width_px;
  const double height = height_px(options);
  const double focal_x = 0.5 * width / std::tan(0.5 * options.fov_x_rad);
  const double focal_y = 0.5 * height / std::tan(0.5 * options.fov_y_rad);
  const double x = 0.5 * width;
  const double y = 0.5 * height;
  return json_text(foxglove::Json{{"timestamp", foxglove::timestamp(time_ns)},
                                  {"frame_id", options.name},
                                  {"width", options.width_px},
                                  {"height", height_px(options)},
                                  {"distortion_model", ""},
                                  {"D", foxglove::Json::array()},
                                  {"K", {focal_x, 0, x, 0, focal_y, y, 0, 0, 1}},
                                  {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                                  {"P", {focal_x, 0, x, 0, 0, focal_y, y, 0, 0, 0, 1, 0}}});
}

enum ChannelIndex : std::size_t { kTransform, kCalibration, kPath, kKeyframes };

std::vector<McapChannel> channels_of(const CameraTrack& track, const CameraWriteOptions& options) {
  std::map<std::string, std::string> remark;
  if (options.has_lens()) remark["near_m"] = number_text(options.near_m);
  if (track.fps) remark["fps"] = number_text(*track.fps);
  return {
      {"/camera/transform", "foxglove.FrameTransform", foxglove::transform_schema().dump(), remark},
      {"/camera/calibration",
       "foxglove.CameraCalibration",
       foxglove::calibration_schema().dump(),
       {}},
      {"/camera/path", "foxglove.PosesInFrame", foxglove::poses_schema().dump(), {}},
      {"/camera/keyframes", "foxglove.PosesInFrame", foxglove::poses_schema().dump(), {}}};
}

/// The times of the keys. Fails if they do not increase.
base::Result<std::vector<std::uint64_t>> nanoseconds_of(const CameraTrack& track) {
  const double first_s = track.keys.front().time_s;
  const double last_s = track.keys.back().time_s;
  const double begin_s = first_s >= 0.0 && last_s < kLatestTime_s ? 0.0 : first_s;
  std::vector<std::uint64_t> times;
  for (const TrackKey& key : track.keys) {
    const double time_ns = std::round((key.time_s - begin_s) * kMcapTicksPerSecond);
    if (!(time_ns < kLatestTime_s * kMcapTicksPerSecond)) {
      return base::Failure{"MCAP has nanoseconds in 64 bits: the path takes longer"};
    }
    times.push_back(static_cast<std::uint64_t>(time_ns));
    if (times.size() > 1 && times[times.size() - 2] >= times.back()) {
      return base::Failure{"MCAP has nanoseconds: two frames are less than one apart"};
    }
  }
  return times;
}

}  // namespace

base::Result<std::string> write_mcap(const CameraTrack& track, const CameraWriteOptions& options) {
  const base::Result<std::vector<std::uint64_t>> times = nanoseconds_of(track);
  if (!times) return base::Failure{times.error};
  const std::uint64_t begin_ns = times->front();
  McapFile file(channels_of(track, options));
  if (options.has_lens()) file.add(kCalibration, begin_ns, calibration_message(options, begin_ns));
  file.add(kPath, begin_ns, foxglove::poses_message(poses_of(track.keys), begin_ns));
  if (!options.keyframes.empty()) {
    file.add(kKeyframes, begin_ns, foxglove::poses_message(poses_of(options.keyframes), begin_ns));
  }
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    file.add(kTransform, (*times)[i],
             foxglove::transform_message(track.keys[i].pose_W, (*times)[i], options.name));
  }
  return file.finish();
}

}  // namespace camway::tools
