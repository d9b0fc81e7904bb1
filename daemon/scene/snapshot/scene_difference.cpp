// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_difference.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace camway::scene {
namespace {

using Object = std::shared_ptr<const SceneObject>;
using Part = std::shared_ptr<const PlacedPart>;

/// A box in the world that contains these voxels of a map and one more on each side: far more than
/// the rounding of their faces.
geometry::Box box_of(const VoxelSet::Range& voxels, const PlacedVoxelMap& solid) {
  geometry::Box box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    geometry::Vec3 at_O;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_high = (corner >> axis & 1U) != 0;
      at_O[static_cast<Eigen::Index>(axis)] =
          (is_high ? voxels[axis].last + 2 : voxels[axis].first - 1) * solid.map->resolution_m();
    }
    box.extend(solid.placement.to_world(at_O));
  }
  return box;
}

/// Collects what one of the scenes has and the other has not.
class Collector {
 public:
  void come(const Object& object) {
    if (object->triangles == 0) return;
    for (const Part& part : object->parts) meshes_.push_back(part->indexed);
    if (auto solid = object->solid()) solids_.push_back(*std::move(solid));
    sum_.added.push_back(object->bounds_W);
  }

  void go(const Object& object) {
    if (object->triangles > 0) sum_.removed.push_back(object->bounds_W);
  }

  void change(const Object& old, const Object& now) {
    const bool is_scanned =
        old->source->map_O && now->source->map_O && old->parts_placement == now->parts_placement &&
        old->source->map_O->resolution_m() == now->source->map_O->resolution_m();
    if (!is_scanned) {
      go(old);
      come(now);
      return;
    }
    change_parts(*old, *now);
    change_solid(*old->solid(), *now->solid());
  }

  SceneDifference take() {
    sum_.index = SceneIndex::of(meshes_);
    if (!solids_.empty()) sum_.solids = std::make_shared<const SceneSolids>(std::move(solids_));
    return std::move(sum_);
  }

 private:
  /// For an occupancy map that was not moved.
  void change_parts(const SceneObject& old, const SceneObject& now) {
    const std::vector<MeshPart>& olds = old.source->parts_O;
    const std::vector<MeshPart>& nows = now.source->parts_O;
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < olds.size() || k < nows.size()) {
      const bool is_old = k == nows.size() || (i < olds.size() && olds[i].key <= nows[k].key);
      const bool is_now = i == olds.size() || (k < nows.size() && nows[k].key <= olds[i].key);
      if (!is_old || !is_now || old.parts[i] != now.parts[k]) {
        if (is_old) sum_.removed.push_back(old.parts[i]->indexed->tree.bounds());
        if (is_now) sum_.added.push_back(now.parts[k]->indexed->tree.bounds());
        if (is_now) meshes_.push_back(now.parts[k]->indexed);
      }
      i += is_old ? 1U : 0U;
      k += is_now ? 1U : 0U;
    }
  }

  /// Voxels that became solid, or are no longer, may lie deep inside, where no face is near.
  void change_solid(const PlacedVoxelMap& old, const PlacedVoxelMap& now) {
    Boxes filled;
    Boxes freed;
    now.map->solid().for_each_difference(
        old.map->solid(),
        [&](std::uint64_t key, const VoxelSet::Bits& before, const VoxelSet::Bits& after) {
          extend(filled, key, after, before);
          extend(freed, key, before, after);
        });
    for (const auto& [cube, voxels] : filled) sum_.added.push_back(box_of(voxels, now));
    for (const auto& [cube, voxels] : freed) sum_.removed.push_back(box_of(voxels, now));
    if (!filled.empty()) solids_.push_back(now);
  }

  /// One box for neighbouring voxels: those of a cube of blocks.
  using Boxes = std::map<std::uint64_t, VoxelSet::Range>;

  /// Extends the boxes by the voxels of a block that are in `these` and not in `others`.
  static void extend(Boxes& boxes, std::uint64_t key, const VoxelSet::Bits& these,
                     const VoxelSet::Bits& others) {
    constexpr unsigned kLevelsOfABox = 3;
    VoxelSet::Bits bits{};
    for (std::size_t z = 0; z < bits.size(); ++z) bits[z] = these[z] & ~others[z];
    if (bits == VoxelSet::Bits{}) return;
    const std::uint64_t cube = BlockKey::first_of_cube(key, kLevelsOfABox);
    VoxelSet::extend(boxes.try_emplace(cube, VoxelSet::kNoVoxels).first->second, key, bits);
  }

  SceneDifference sum_;
  std::vector<std::shared_ptr<const IndexedMesh>> meshes_;
  std::vector<PlacedVoxelMap> solids_;
};

}  // namespace

SceneDifference difference(const Snapshot& before, const Snapshot& after) {
  Collector collector;
  auto old = before.objects.begin();
  auto now = after.objects.begin();
  while (old != before.objects.end() || now != after.objects.end()) {
    const bool no_old = old == before.objects.end();
    const bool no_now = now == after.objects.end();
    if (no_old || (!no_now && (*now)->name < (*old)->name)) {
      collector.come(*now++);
    } else if (no_now || (*old)->name < (*now)->name) {
      collector.go(*old++);
    } else {
      if (*old != *now) collector.change(*old, *now);
      ++old;
      ++now;
    }
  }
  SceneDifference sum = collector.take();
  sum.other_bounds = !(before.options.bounds == after.options.bounds);
  sum.surface_error_m = after.report.surface_error_m;
  sum.is_coarser = after.report.surface_error_m > before.report.surface_error_m;
  return sum;
}

}  // namespace camway::scene
