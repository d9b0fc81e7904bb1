// SPDX-License-Identifier: MIT
#include "tools/cameras/export/file_mapping.h"

#include <numbers>

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;

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

}  // namespace

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

scene::UpAxis inverse(scene::UpAxis up) {
  if (up == scene::UpAxis::kZToY) return scene::UpAxis::kYToZ;
  return up == scene::UpAxis::kYToZ ? scene::UpAxis::kZToY : up;
}

CameraTrack as_in_file(const CameraTrack& track, const FileMapping& mapping) {
  CameraTrack result = track;
  place_as_scene(result, 1.0 / mapping.scale, inverse(mapping.up));
  if (mapping.file_axes == mapping.format_axes) return result;
  // The half turn between both frames, which the writer or the reader's option makes again.
  for (TrackKey& key : result.keys) {
    key.pose_W.orientation = with_other_axes(key.pose_W.orientation, CameraAxes::kCv);
  }
  return result;
}

}  // namespace camway::tools
