// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/clearance_field.h"
#include "daemon/scene/snapshot.h"

namespace camway::collision {

/// What a path is checked against. Refers to what it was made from, which must outlive it.
struct Obstacles {
  // Implicit on purpose: wherever a scene is asked for, an index or a snapshot will do.
  Obstacles(const scene::SceneIndex& scene_index) : index(scene_index) {}  // NOLINT
  Obstacles(const scene::Snapshot& snapshot)                               // NOLINT
      : index(snapshot.index), field(snapshot.field.get()), solids(snapshot.solids.get()) {}

  const scene::SceneIndex& index;
  const scene::ClearanceField* field = nullptr;  ///< may be absent: it spares time, no more
  const scene::SceneSolids* solids = nullptr;    ///< null if nothing of the scene has an inside
};

}  // namespace camway::collision
