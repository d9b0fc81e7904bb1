// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/mcap_file.h"
#include "tools/cameras/formats/mcap_formats.h"

namespace camway::tools {
namespace {

using McapJson = nlohmann::ordered_json;

constexpr const char* kWorldFrame = "world";
constexpr double kMcapTicksPerSecond = 1e9;
constexpr std::uint64_t kNanoseconds = 1'000'000'000;
/// Later times do not fit into 63 bits of nanoseconds, so they count from 0.
constexpr double kLatestTime_s = 9.2e9;

/// Schemas with the members that Camway writes. A reader may know more, so others are allowed.
McapJson object_schema(const McapJson& members) {
  return {{"type", "object"}, {"properties", members}, {"additionalProperties", true}};
}

McapJson numbers_schema(std::initializer_list<const char*> names) {
  McapJson members;
  for (const char* const name : names) members[name] = {{"type", "number"}};
  return object_schema(members);
}

McapJson titled(const char* title, const char* description, McapJson members) {
  const McapJson time = object_schema(
      {{"sec", {{"type", "integer"}, {"minimum", 0}}},
       {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", kNanoseconds - 1}}}});
  McapJson with_time{{"timestamp", time}};
  with_time.update(members);
  McapJson schema{{"title", title}, {"description", description}};
  schema.update(object_schema(with_time));
  return schema;
}

McapJson text_schema() { return {{"type", "string"}}; }

McapJson transform_schema() {
  return titled("foxglove.FrameTransform", "A transform between two frames",
                {{"parent_frame_id", text_schema()},
                 {"child_frame_id", text_schema()},
                 {"translation", numbers_schema({"x", "y", "z"})},
                 {"rotation", numbers_schema({"x", "y", "z", "w"})}});
}

McapJson poses_schema() {
  const McapJson pose = object_schema({{"position", numbers_schema({"x", "y", "z"})},
                                       {"orientation", numbers_schema({"x", "y", "z", "w"})}});
  return titled("foxglove.PosesInFrame", "Poses in a frame",
                {{"frame_id", text_schema()}, {"poses", {{"type", "array"}, {"items", pose}}}});
}

McapJson calibration_schema() {
  const auto numbers = [](std::size_t least, std::size_t most) -> McapJson {
    return {{"type", "array"},
            {"items", {{"type", "number"}}},
            {"minItems", least},
            {"maxItems", most}};
  };
  const McapJson whole{{"type", "integer"}, {"minimum", 0}};
  return titled("foxglove.CameraCalibration", "The lens of a camera",
                {{"frame_id", text_schema()},
                 {"width", whole},
                 {"height", whole},
                 {"distortion_model", text_schema()},
                 {"D", numbers(0, 0)},
                 {"K", numbers(9, 9)},
                 {"R", numbers(9, 9)},
                 {"P", numbers(12, 12)}});
}

McapJson vector_json(const geometry::Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

/// The orientation of the optical frame.
McapJson rotation_json(const motion::Pose& pose) {
  const geometry::Quat q = with_other_axes(pose.orientation, CameraAxes::kCv);
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

McapJson timestamp(std::uint64_t time_ns) {
  return {{"sec", time_ns / kNanoseconds}, {"nsec", time_ns % kNanoseconds}};
}

std::string transform_message(const TrackKey& key, std::uint64_t time_ns, const std::string& name) {
  return McapJson{{"timestamp", timestamp(time_ns)},
                  {"parent_frame_id", kWorldFrame},
                  {"child_frame_id", name},
                  {"translation", vector_json(key.pose_W.position)},
                  {"rotation", rotation_json(key.pose_W)}}
      .dump();
}

std::string poses_message(const std::vector<TrackKey>& keys, std::uint64_t time_ns) {
  McapJson poses = McapJson::array();
  for (const TrackKey& key : keys) {
    poses.push_back({{"position", vector_json(key.pose_W.position)},
                     {"orientation", rotation_json(key.pose_W)}});
  }
  return McapJson{
      {"timestamp", timestamp(time_ns)}, {"frame_id", kWorldFrame}, {"poses", std::move(poses)}}
      .dump();
}

std::string calibration_message(const CameraWriteOptions& options, std::uint64_t time_ns) {
  const double width = options.width_px;
  const double height = height_px(options);
  const double focal_x = 0.5 * width / std::tan(0.5 * options.fov_x_rad);
  const double focal_y = 0.5 * height / std::tan(0.5 * options.fov_y_rad);
  const double x = 0.5 * width;
  const double y = 0.5 * height;
  return McapJson{{"timestamp", timestamp(time_ns)},
                  {"frame_id", options.name},
                  {"width", options.width_px},
                  {"height", height_px(options)},
                  {"distortion_model", ""},
                  {"D", McapJson::array()},
                  {"K", {focal_x, 0, x, 0, focal_y, y, 0, 0, 1}},
                  {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                  {"P", {focal_x, 0, x, 0, 0, focal_y, y, 0, 0, 0, 1, 0}}}
      .dump();
}

enum ChannelIndex : std::size_t { kTransform, kCalibration, kPath, kKeyframes };

std::vector<McapChannel> channels_of(const CameraTrack& track, const CameraWriteOptions& options) {
  std::map<std::string, std::string> remark;
  if (options.has_lens()) remark["near_m"] = number_text(options.near_m);
  if (track.fps) remark["fps"] = number_text(*track.fps);
  return {{"/camera/transform", "foxglove.FrameTransform", transform_schema().dump(), remark},
          {"/camera/calibration", "foxglove.CameraCalibration", calibration_schema().dump(), {}},
          {"/camera/path", "foxglove.PosesInFrame", poses_schema().dump(), {}},
          {"/camera/keyframes", "foxglove.PosesInFrame", poses_schema().dump(), {}}};
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
  file.add(kPath, begin_ns, poses_message(track.keys, begin_ns));
  if (!options.keyframes.empty()) {
    file.add(kKeyframes, begin_ns, poses_message(options.keyframes, begin_ns));
  }
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    file.add(kTransform, (*times)[i], transform_message(track.keys[i], (*times)[i], options.name));
  }
  return file.finish();
}

}  // namespace camway::tools
