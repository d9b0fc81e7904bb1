// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_difference.h"

#include <memory>
#include <utility>
#include <vector>

namespace camway::scene {
namespace {

/// Puts what counts of objects together.
SceneDifference difference_of(const SceneObjects& added, const SceneObjects& removed) {
  SceneDifference sum;
  std::vector<std::shared_ptr<const IndexedMesh>> meshes;
  std::vector<PlacedVoxelMap> solids;
  for (const auto& object : added) {
    meshes.push_back(object->placed);
    sum.added.push_back(object->placed->tree.bounds());
    if (auto solid = object->solid()) solids.push_back(*std::move(solid));
  }
  for (const auto& object : removed) sum.removed.push_back(object->placed->tree.bounds());
  sum.index = SceneIndex::of(meshes);
  if (!solids.empty()) sum.solids = std::make_shared<const SceneSolids>(std::move(solids));
  return sum;
}

void add(const std::shared_ptr<const SceneObject>& object, SceneObjects& objects) {
  if (!object->placed->mesh->triangles.empty()) objects.push_back(object);
}

}  // namespace

SceneDifference difference(const Snapshot& before, const Snapshot& after) {
  SceneObjects added;
  SceneObjects removed;
  auto old = before.objects.begin();
  auto now = after.objects.begin();
  while (old != before.objects.end() || now != after.objects.end()) {
    const bool no_old = old == before.objects.end();
    const bool no_now = now == after.objects.end();
    if (no_old || (!no_now && (*now)->name < (*old)->name)) {
      add(*now++, added);
    } else if (no_now || (*old)->name < (*now)->name) {
      add(*old++, removed);
    } else {
      if (*old != *now) {
        add(*old, removed);
        add(*now, added);
      }
      ++old;
      ++now;
    }
  }
  return difference_of(added, removed);
}

}  // namespace camway::scene
