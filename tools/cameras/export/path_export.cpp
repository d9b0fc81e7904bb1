// SPDX-License-Identifier: MIT
#include "tools/cameras/export/path_export.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/planning/result/path_faults.h"
#include "tools/cameras/path_samples.h"

namespace camway::tools {
namespace {

/// Ten hours at 24 frames a second.
constexpr double kMostFrames = 1e6;

constexpr double kUsualRate = 24.0;

/// The path at its keyframes. Leaves out those whose time is unknown.
std::vector<TrackKey> keyframes_of(const PathFile& response) {
  std::vector<TrackKey> keys;
  for (const motion::Keyframe& keyframe : response.keyframes) {
    if (!std::isfinite(keyframe.time_s)) continue;
    keys.push_back({keyframe.time_s, response.path.pose(keyframe.time_s), std::nullopt});
  }
  return keys;
}

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

}  // namespace

CameraRemark camera_remark(const std::string& request_text) {
  const nlohmann::json request = nlohmann::json::parse(request_text, nullptr, false);
  CameraRemark remark;
  if (!request.is_object() || !request.contains(kCameraRemark)) return remark;
  const nlohmann::json& camera = request[kCameraRemark];
  if (!camera.is_object()) return remark;
  if (camera.contains("name") && camera["name"].is_string()) camera["name"].get_to(remark.name);
  if (camera.contains("fps") && camera["fps"].is_number() && camera["fps"].get<double>() > 0.0) {
    remark.fps = camera["fps"].get<double>();
  }
  return remark;
}

base::Result<PathExport> path_export(const RequestFile& request, const ExportDocuments& documents,
                                     std::optional<double> fps) {
  base::Result<PathFile> response = read_path(documents);
  if (!response) return base::Failure{response.error};
  const CameraRemark remark = camera_remark(documents.request_text);
  const double rate = fps ? *fps : remark.fps.value_or(kUsualRate);
  if (frame_count(response->path, rate) > kMostFrames) {
    return base::Failure{
        fmt::format("{}: has more than {} frames", documents.response_name, kMostFrames)};
  }
  if (!(request.camera.fov_x_rad > 0.0)) {
    return base::Failure{documents.request_name + ": camera: is missing"};
  }
  CameraWriteOptions options;
  if (!remark.name.empty()) options.name = remark.name;
  options.fov_x_rad = request.camera.fov_x_rad;
  options.fov_y_rad = request.camera.fov_y_rad;
  options.near_m = request.camera.near_m * response->near_scale;
  options.corrections = corrections_of(documents.response_text);
  options.keyframes = keyframes_of(*response);
  return PathExport{rate, *std::move(response), std::move(options)};
}

base::Result<std::string> exported_frames(const CameraFormat& format, const PathExport& path) {
  return format.write(frames_of(path.response.path, path.fps, path.response.path.begin_s()),
                      path.options);
}

}  // namespace camway::tools
