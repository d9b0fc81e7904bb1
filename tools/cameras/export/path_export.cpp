// SPDX-License-Identifier: MIT
#include "tools/cameras/export/path_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/planning/result/path_faults.h"
#include "tools/cameras/export/camera_remark.h"
#include "tools/cameras/frame_rate.h"
#include "tools/cameras/path_samples.h"

namespace camway::tools {
namespace {

/// Ten hours at 24 frames a second.
constexpr double kMostFrames = 1e6;

constexpr double kUsualRate = 24.0;
constexpr int kUsualWidth_px = 1920;

/// The stretches that corrections changed; none where the file is no whole response.
std::vector<CorrectedStretch> corrections_of(const std::string& text) {
  const base::Result<planning::PlanResult> response =
      parse_as<planning::PlanResult>(text, "response");
  std::vector<CorrectedStretch> stretches;
  if (!response) return stretches;
  for (const correction::Correction& each : response->corrections) {
    if (each.kind == correction::CorrectionKind::kNone) continue;
    const CorrectedStretch stretch{each.t_begin_s, each.t_end_s, each.moved_m};
    // One correction may be that of several collisions.
    const bool is_same = !stretches.empty() && stretches.back().t_begin_s == stretch.t_begin_s &&
                         stretches.back().t_end_s == stretch.t_end_s;
    if (!is_same) stretches.push_back(stretch);
  }
  return stretches;
}

/// Reads a path without faults.
base::Result<PathFile> read_path(const ExportDocuments& documents) {
  base::Result<PathFile> response =
      parse_as<PathFile>(documents.response_text, documents.response_name);
  if (!response) return response;
  if (response->path.empty()) return base::Failure{documents.response_name + ": has no path"};
  if (const auto fault = planning::find_fault(response->path.segments())) {
    return base::Failure{documents.response_name + ": " + *fault};
  }
  return response;
}

/// The differences between the file's poses and those of the request: as in the imported file,
/// unless choices say otherwise, or the format says what they are.
FileMapping mapping_of(const ExportChoices& choices, const CameraFormat& format,
                       const CameraRemark& remark) {
  const FormatTraits traits = traits_of(format);
  const bool is_same = remark.format == format.name;
  FileMapping mapping{traits.axes, traits.axes};
  if (is_same && remark.facts.is_euroc) mapping.file_axes = CameraAxes::kCv;
  if (is_same && remark.axes && traits.has_free_axes) mapping.file_axes = *remark.axes;
  if (choices.axes) mapping.file_axes = *choices.axes;
  if (is_same || traits.has_free_world) {
    mapping.scale = remark.scale;
    mapping.up = remark.up;
  }
  if (choices.scale) mapping.scale = *choices.scale;
  if (choices.up) mapping.up = *choices.up;
  return mapping;
}

/// The facts that the file shall have. Names of pictures and units of tables go with their format.
FileFacts facts_of(const ExportChoices& choices, const CameraFormat& format,
                   const CameraRemark& remark) {
  FileFacts facts = remark.facts;
  if (remark.format != format.name) {
    facts.images.clear();
    facts.is_euroc = false;
    facts.time_units = facts.length_units = 1.0;
  }
  if (choices.first_frame) facts.first_frame = choices.first_frame;
  if (choices.width_px || facts.width_px == 0) {
    facts.width_px = choices.width_px.value_or(kUsualWidth_px);
    facts.height_px = 0;
  }
  if (choices.height_px) facts.height_px = *choices.height_px;
  return facts;
}

CameraWriteOptions options_of(const ExportChoices& choices, const PathExport& path,
                              const motion::Camera& camera, const CameraRemark& remark) {
  CameraWriteOptions options;
  options.name = choices.name.value_or(remark.name.empty() ? "camera" : remark.name);
  options.fov_x_rad = camera.fov_x_rad;
  options.fov_y_rad = camera.fov_y_rad;
  options.near_m = camera.near_m * path.response.near_scale / path.mapping.scale;
  options.facts = facts_of(choices, *path.format, remark);
  options.width_px = options.facts.width_px;
  CameraTrack keyframes;
  keyframes.keys = keyframes_of(path.response);
  options.keyframes = as_in_file(keyframes, path.mapping).keys;
  return options;
}

/// Returns why the choices do not go with the format; empty if they do.
std::string format_fault(const ExportChoices& choices, const CameraFormat& format,
                         const RequestFile& request, const std::string& request_name) {
  const FormatTraits traits = traits_of(format);
  if (traits.needs_lens && !(request.camera.fov_x_rad > 0.0)) {
    return fmt::format(
        "{}: camera: is missing, whose field of view {} needs; tum, kitti, csv, chan and mcap do "
        "not",
        request_name, format.name);
  }
  if (choices.axes && !traits.has_free_axes) {
    return fmt::format("--camera-axes: {} has axes of its own", format.name);
  }
  if (choices.first_frame && !traits.counts_frames) {
    return fmt::format("--first-frame: {} does not number frames; blender and chan do",
                       format.name);
  }
  if ((choices.width_px || choices.height_px) && !traits.has_picture) {
    return fmt::format("--{}: {} has no size of a picture{}", choices.width_px ? "width" : "height",
                       format.name,
                       traits.needs_lens ? ", but the fields of view of the request" : "");
  }
  return "";
}

/// Returns why the path has no such frames; empty if it has.
std::string frames_fault(const PathExport& path, const std::string& source) {
  if (path.has_keyframes_only) return "";
  const double frames = frame_count(path.response.path, path.fps);
  if (frames > kMostFrames) return fmt::format("{}: has more than {} frames", source, kMostFrames);
  if (frames < 2.0) {
    return fmt::format("{}: is shorter than a frame of {:g} a second: --fps must be higher", source,
                       path.fps);
  }
  return "";
}

}  // namespace

std::vector<TrackKey> keyframes_of(const PathFile& response) {
  std::vector<TrackKey> keys;
  for (const motion::Keyframe& keyframe : response.keyframes) {
    if (!std::isfinite(keyframe.time_s)) continue;
    keys.push_back({keyframe.time_s, response.path.pose(keyframe.time_s), std::nullopt});
  }
  return keys;
}

base::Result<PathExport> path_export(const RequestFile& request, const ExportDocuments& documents,
                                     const CameraFormat& format, const ExportChoices& choices) {
  base::Result<PathFile> response = read_path(documents);
  if (!response) return base::Failure{response.error};
  if (std::string fault = format_fault(choices, format, request, documents.request_name);
      !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  const CameraRemark remark = camera_remark(documents.request_text);
  PathExport path;
  path.format = &format;
  path.response = *std::move(response);
  path.fps = choices.fps ? *choices.fps : remark.fps.value_or(kUsualRate);
  path.is_fps_known = choices.fps || remark.fps;
  if (!path.is_fps_known && !remark.has_times && !traits_of(format).has_times) {
    path.has_keyframes_only = keyframes_of(path.response).size() > 1;
  }
  path.mapping = mapping_of(choices, format, remark);
  path.options = options_of(choices, path, request.camera, remark);
  path.options.corrections = corrections_of(documents.response_text);
  if (std::string fault = frames_fault(path, documents.response_name); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  return path;
}

CameraTrack dense_track(const PathExport& exported) {
  std::vector<double> times_s;
  for (const TrackKey& key : keyframes_of(exported.response)) times_s.push_back(key.time_s);
  const motion::Path& path = exported.response.path;
  if (exported.has_keyframes_only) return poses_at(path, times_s);
  CameraTrack track = frames_of(path, exported.fps, path.begin_s());
  std::vector<double> frames_s;
  for (const TrackKey& key : track.keys) {
    const auto after = std::ranges::lower_bound(times_s, key.time_s - kOnFrame / exported.fps);
    const bool is_keyframe =
        after != times_s.end() && *after <= key.time_s + kOnFrame / exported.fps;
    frames_s.push_back(std::min(is_keyframe ? *after : key.time_s, path.end_s()));
  }
  track = poses_at(path, frames_s);
  track.fps = exported.fps;
  return track;
}

base::Result<std::string> written_file(const PathExport& path, const CameraTrack& track) {
  return path.format->write(as_in_file(track, path.mapping), path.options);
}

}  // namespace camway::tools
