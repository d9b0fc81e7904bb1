// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_difference.h"

#include <memory>

namespace camway::scene {
namespace {

using Meshes = std::vector<std::shared_ptr<const IndexedMesh>>;

void add(const SceneObject& object, Meshes& meshes) {
  if (!object.placed->mesh->triangles.empty()) meshes.push_back(object.placed);
}

std::vector<geometry::Box> boxes_of(const Meshes& meshes) {
  std::vector<geometry::Box> boxes;
  for (const auto& mesh : meshes) boxes.push_back(mesh->tree.bounds());
  return boxes;
}

}  // namespace

SceneDifference difference(const Snapshot& before, const Snapshot& after) {
  Meshes added;
  Meshes removed;
  auto old = before.objects.begin();
  auto now = after.objects.begin();
  while (old != before.objects.end() || now != after.objects.end()) {
    const bool no_old = old == before.objects.end();
    const bool no_now = now == after.objects.end();
    if (no_old || (!no_now && (*now)->name < (*old)->name)) {
      add(**now++, added);
    } else if (no_now || (*old)->name < (*now)->name) {
      add(**old++, removed);
    } else {
      if ((*old)->placed != (*now)->placed) {
        add(**old, removed);
        add(**now, added);
      }
      ++old;
      ++now;
    }
  }
  return {SceneIndex::of(added), boxes_of(added), boxes_of(removed)};
}

}  // namespace camway::scene
