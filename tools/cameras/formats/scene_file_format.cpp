// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/scene_file_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/scene/import/camera_import.h"

namespace camway::tools {
namespace {

using scene::SceneFileCamera;

/// The one of this name, or the first one that moves, or the first one.
const SceneFileCamera* choose(const std::vector<SceneFileCamera>& cameras,
                              const std::string& name) {
  const auto found = std::ranges::find_if(cameras, [&](const SceneFileCamera& camera) {
    return name.empty() ? camera.keys.size() > 1 : camera.name == name;
  });
  if (found != cameras.end()) return &*found;
  return name.empty() && !cameras.empty() ? &cameras.front() : nullptr;
}

std::string names_of(const std::vector<SceneFileCamera>& cameras) {
  std::string names;
  for (const SceneFileCamera& camera : cameras) {
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  return names;
}

/// Whether the file seems to animate a lens: by a channel of COLLADA, or a curve of FBX.
bool animates_a_lens(std::string_view bytes) {
  constexpr std::array<std::string_view, 6> kMarks = {
      "/xfov\"",
      "/yfov\"",
      std::string_view("FocalLength\0\1AnimCurveNode", 26),
      std::string_view("FieldOfView\0\1AnimCurveNode", 26),
      "AnimCurveNode::FocalLength",
      "AnimCurveNode::FieldOfView"};
  return std::ranges::any_of(
      kMarks, [&](std::string_view mark) { return bytes.find(mark) != std::string_view::npos; });
}

}  // namespace

base::Result<CameraTrack> read_scene_file(const CameraFile& file,
                                          const CameraReadOptions& options) {
  const auto cameras = scene::import_cameras(file.name);
  if (!cameras) {
    const bool has_name = cameras.error.starts_with(file.name + ": ");
    return base::Failure{has_name ? cameras.error.substr(file.name.size() + 2) : cameras.error};
  }
  const SceneFileCamera* const camera = choose(*cameras, options.camera);
  if (camera == nullptr) {
    return base::Failure{"has no camera '" + options.camera + "': " + names_of(*cameras)};
  }
  CameraTrack track;
  track.name = camera->name;
  track.fps = options.fps;
  track.fov_x_rad = camera->fov_x_rad;
  track.aspect = camera->aspect;
  track.near_m = camera->near_m;
  if (options.camera.empty() && cameras->size() > 1) {
    track.notes.push_back(choice_note(camera->name, names_of(*cameras)));
  }
  if (camera->takes > 1) {
    track.notes.push_back(fmt::format(
        "{} animations of the file move the camera, and the first counts: export another one alone",
        camera->takes));
  }
  if (animates_a_lens(file.bytes)) {
    track.notes.emplace_back(
        "the file animates a lens, which is not read: if it changes, the angle may be the "
        "narrowest, so give the widest with --fov-x-deg or --fov-y-deg");
  }
  const CameraAxes axes = options.axes.value_or(CameraAxes::kGl);
  for (const scene::CameraFileKey& key : camera->keys) {
    const geometry::Quat orientation =
        key.orientation.norm() > 0.0 ? key.orientation.normalized() : key.orientation;
    track.keys.push_back({key.time_s, {key.position_m, with_other_axes(orientation, axes)}, {}});
  }
  return track;
}

}  // namespace camway::tools
