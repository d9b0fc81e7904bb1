// SPDX-License-Identifier: MIT
#include "tools/camway/cameras/import_request.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/base/named_enum.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/cameras/export/path_export.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using Json = nlohmann::ordered_json;

constexpr double kUsualAspect = 16.0 / 9.0;
constexpr double kUsualNear_m = 0.1;

/// The turn of the axes of a scene file (`UpAxis`).
Quat turn_of(scene::UpAxis up) {
  const double half = std::numbers::sqrt2 / 2.0;
  switch (up) {
    case scene::UpAxis::kZToY:
      return {half, -half, 0.0, 0.0};
    case scene::UpAxis::kYToZ:
      return {half, half, 0.0, 0.0};
    case scene::UpAxis::kAsInFile:
      break;
  }
  return Quat::Identity();
}

Vec3 turned(const Vec3& p, scene::UpAxis up) {
  switch (up) {
    case scene::UpAxis::kZToY:
      return {p.x(), p.z(), -p.y()};
    case scene::UpAxis::kYToZ:
      return {p.x(), -p.z(), p.y()};
    case scene::UpAxis::kAsInFile:
      break;
  }
  return p;
}

bool changes_lens(const CameraTrack& track) {
  for (const TrackKey& key : track.keys) {
    const TrackKey& first = track.keys.front();
    if (key.fov_y_rad != first.fov_y_rad || key.fov_x_rad != first.fov_x_rad) return true;
  }
  return false;
}

double aspect_of(CameraTrack& track, const ImportLens& lens) {
  if (lens.aspect) return *lens.aspect;
  if (track.aspect) return *track.aspect;
  track.notes.emplace_back("the width of the picture is not stated: 16:9 is assumed (--aspect)");
  return kUsualAspect;
}

}  // namespace

base::Result<RequestCamera> camera_of(CameraTrack& track, const ImportLens& lens) {
  std::optional<double> fov_x_rad = widest_fov_x_rad(track);
  std::optional<double> fov_y_rad = widest_fov_y_rad(track);
  if (lens.fov_x_deg || lens.fov_y_deg) {
    fov_x_rad = fov_y_rad = std::nullopt;
    if (lens.fov_x_deg) fov_x_rad = radians(*lens.fov_x_deg);
    if (lens.fov_y_deg) fov_y_rad = radians(*lens.fov_y_deg);
  } else if (changes_lens(track)) {
    track.notes.push_back(
        fmt::format("the lens changes: its widest angle counts, {:.4g} degrees {}",
                    degrees(fov_y_rad ? *fov_y_rad : fov_x_rad.value_or(0.0)),
                    fov_y_rad ? "upwards" : "across"));
  }
  if (!fov_x_rad && !fov_y_rad) {
    return base::Failure{"states no field of view" +
                         (track.why_no_fov.empty() ? "" : " (" + track.why_no_fov + ")") +
                         ": give --fov-y-deg, and --aspect or --fov-x-deg"};
  }
  if (!fov_x_rad) fov_x_rad = fov_across_rad(*fov_y_rad, aspect_of(track, lens));
  if (!fov_y_rad) fov_y_rad = fov_across_rad(*fov_x_rad, 1.0 / aspect_of(track, lens));
  const std::optional<double> near_m = lens.near_m ? lens.near_m : track.near_m;
  if (!near_m) {
    track.notes.push_back(
        fmt::format("the near distance is not stated: {} m is assumed (--near-m)", kUsualNear_m));
  }
  return RequestCamera{*fov_x_rad, *fov_y_rad, near_m.value_or(kUsualNear_m)};
}

void place_as_scene(CameraTrack& track, double scale, scene::UpAxis up) {
  const Quat turn = turn_of(up);
  for (TrackKey& key : track.keys) {
    key.pose_W.position = turned(scale * key.pose_W.position, up);
    key.pose_W.orientation = turn * key.pose_W.orientation;
  }
  for (KeyTangents& tangents : track.tangents) {
    for (Vec3* const velocity : {&tangents.position_in_m_per_s, &tangents.position_out_m_per_s}) {
      *velocity = turned(scale * *velocity, up);
    }
    for (geometry::Vec4* const rate :
         {&tangents.orientation_in_per_s, &tangents.orientation_out_per_s}) {
      *rate = geometry::wxyz(turn * geometry::from_wxyz(*rate));
    }
  }
  if (track.near_m) *track.near_m *= scale;
}

Json request_json(const CameraTrack& track, const ThinnedTrack& kept, const RequestCamera& camera,
                  const RequestScene& scene) {
  Json json;
  json[kCameraRemark] = {{"name", track.name}};
  if (track.fps) json[kCameraRemark]["fps"] = *track.fps;
  if (!scene.file.empty()) json["scene"] = scene.file;
  if (scene.scale != 1.0) json["scale"] = scene.scale;
  if (scene.up != scene::UpAxis::kAsInFile) json["up"] = base::name_of(scene.up);
  json["camera"] = {{"fov_x_deg", degrees(camera.fov_x_rad)},
                    {"fov_y_deg", degrees(camera.fov_y_rad)},
                    {"near", camera.near_m}};
  json["keyframes"] = Json::array();
  for (const std::size_t i : kept.kept) {
    const motion::Pose& pose = track.keys[i].pose_W;
    const Quat q = pose.orientation.normalized();
    Json keyframe;
    if (track.has_times) keyframe["time"] = track.keys[i].time_s;
    keyframe["position"] = {pose.position.x(), pose.position.y(), pose.position.z()};
    keyframe["orientation"] = {q.w(), q.x(), q.y(), q.z()};
    json["keyframes"].push_back(std::move(keyframe));
  }
  return json;
}

}  // namespace camway::tools
