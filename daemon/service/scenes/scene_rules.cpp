// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_rules.h"

#include <fmt/format.h>

namespace camway::service {

std::string_view setting_of(scene::Limit limit) {
  switch (limit) {
    case scene::Limit::kNone:
      return "";
    case scene::Limit::kScenes:
      return "scenes.scenes";
    case scene::Limit::kObjects:
      return "scenes.objects";
    case scene::Limit::kTriangles:
      return "scenes.triangles";
    case scene::Limit::kOccupancyBytes:
      return "scenes.occupancy_bytes";
    case scene::Limit::kMirrorVoxels:
      return "scenes.mirror_voxels";
    case scene::Limit::kMapVoxels:
      return "scenes.map_voxels";
    case scene::Limit::kMapTriangles:
      return "scenes.map_triangles";
    case scene::Limit::kScanVoxels:
      return "scenes.scan_voxels";
  }
  return "";
}

std::string with_setting(std::string_view error, scene::Limit limit) {
  if (limit == scene::Limit::kNone) return std::string(error);
  return fmt::format("{} ({})", error, setting_of(limit));
}

}  // namespace camway::service
