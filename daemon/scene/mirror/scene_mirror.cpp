// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/scene_mirror.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cassert>
#include <fstream>
#include <limits>
#include <utility>

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;
using octomap::OcTree;
using octomap::OcTreeKey;

using Mirrors = std::vector<std::shared_ptr<const ObjectMirror>>;

/// Marks in `whole` every voxel of an occupied cube.
void mark(const VoxelCube& cube, OcTree& whole) {
  const auto key = [](std::int32_t voxel, std::int32_t step) {
    return static_cast<octomap::key_type>(voxel - VoxelGrid::kMinVoxel + step);
  };
  const float occupied = whole.getClampingThresMaxLog();
  for (std::int32_t x = 0; x < cube.size; ++x) {
    for (std::int32_t y = 0; y < cube.size; ++y) {
      for (std::int32_t z = 0; z < cube.size; ++z) {
        whole.setNodeValue(OcTreeKey(key(cube.min[0], x), key(cube.min[1], y), key(cube.min[2], z)),
                           occupied,
                           /*lazy_eval=*/true);
      }
    }
  }
}

/// The union of all mirrors as one OctoMap.
OcTree united(const Mirrors& mirrors, double resolution_m) {
  OcTree whole(resolution_m);
  for (const std::shared_ptr<const ObjectMirror>& mirror : mirrors) {
    mirror->tree().for_each_cube([&](const VoxelCube& cube) { mark(cube, whole); });
  }
  whole.updateInnerOccupancy();
  whole.prune();
  return whole;
}

}  // namespace

SceneMirror::SceneMirror(std::shared_ptr<const ObjectMirror> mirror)
    : SceneMirror(mirror->resolution_m(), Mirrors{mirror}) {}

SceneMirror::SceneMirror(double resolution_m, Mirrors mirrors) : mirrors_(std::move(mirrors)) {
  statistics_.resolution_m = resolution_m;
  for (const std::shared_ptr<const ObjectMirror>& mirror : mirrors_) {
    assert(mirror && mirror->resolution_m() == resolution_m);
    statistics_.occupied_voxels += mirror->statistics().occupied_voxels;
    statistics_.nodes += mirror->statistics().nodes;
    statistics_.memory_bytes += mirror->statistics().memory_bytes;
  }
}

bool SceneMirror::occupied_at(const Vec3& point_W) const {
  return std::ranges::any_of(mirrors_,
                             [&](const auto& mirror) { return mirror->occupied_at(point_W); });
}

bool SceneMirror::occupied_in_box(const Box& box_W) const {
  return std::ranges::any_of(mirrors_,
                             [&](const auto& mirror) { return mirror->occupied_in_box(box_W); });
}

bool SceneMirror::occupied_in_sphere(const Vec3& center_W, double radius_m) const {
  return std::ranges::any_of(
      mirrors_, [&](const auto& mirror) { return mirror->occupied_in_sphere(center_W, radius_m); });
}

std::optional<double> SceneMirror::ray_hit_m(const Vec3& origin_W, const Vec3& direction_W,
                                             double max_range_m) const {
  std::optional<double> nearest;
  for (const std::shared_ptr<const ObjectMirror>& mirror : mirrors_) {
    const std::optional<double> hit =
        mirror->ray_hit_m(origin_W, direction_W, nearest.value_or(max_range_m));
    if (hit) nearest = hit;
  }
  return nearest;
}

std::optional<double> SceneMirror::distance_m(const Vec3& point_W, double max_distance_m) const {
  std::optional<double> nearest;
  for (const std::shared_ptr<const ObjectMirror>& mirror : mirrors_) {
    const std::optional<double> distance =
        mirror->distance_m(point_W, nearest.value_or(max_distance_m));
    if (distance) nearest = distance;
  }
  return nearest;
}

std::optional<double> SceneMirror::sphere_path_hit_m(const Vec3& from_W, const Vec3& to_W,
                                                     double radius_m) const {
  std::optional<double> nearest;
  for (const std::shared_ptr<const ObjectMirror>& mirror : mirrors_) {
    const std::optional<double> hit = mirror->sphere_path_hit_m(from_W, to_W, radius_m);
    if (hit && (!nearest || *hit < *nearest)) nearest = hit;
  }
  return nearest;
}

void SceneMirror::write_bt(std::ostream& out) const {
  const OcTree tree = united(mirrors_, resolution_m());
  // Not OcTree::writeBinaryConst: it prints the resolution with six digits, which scales the map of
  // any other resolution, and writes to stderr. The call below is not virtual for the latter
  // reason: the installed library was built with its debug output on.
  const std::streamsize precision = out.precision(std::numeric_limits<double>::max_digits10);
  out << "# Octomap OcTree binary file\n# conservative mirror of a Camway scene\n#\n"
      << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
      << "\ndata\n";
  out.precision(precision);
  tree.octomap::OccupancyOcTreeBase<octomap::OcTreeNode>::writeBinaryData(out);
}

std::string SceneMirror::write_bt(const std::filesystem::path& file) const {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) return "cannot open '" + file.string() + "' for writing";
  write_bt(out);
  out.close();
  if (!out) return "cannot write '" + file.string() + "'";
  return {};
}

}  // namespace camway::scene
