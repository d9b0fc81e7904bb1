// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// Where two revisions of a scene differ. Every triangle of the later one is one of `index`, or a
/// triangle of the earlier one in the same place; every solid likewise.
struct SceneDifference {
  /// What the later one has and the earlier one has not, or has elsewhere.
  SceneIndex index;
  std::shared_ptr<const SceneSolids> solids;  ///< null if nothing of it has an inside
  /// Boxes that hold all triangles of `index`, and what of `solids` was not solid: of objects, or
  /// of what changed of an occupancy map.
  std::vector<geometry::Box> added;
  /// Boxes of what the earlier one has and the later one has not, or has elsewhere.
  std::vector<geometry::Box> removed;

  bool other_bounds = false;  ///< whether what bodies must not leave is another

  [[nodiscard]] bool empty() const { return added.empty() && removed.empty() && !other_bounds; }
};

/// Objects, and the parts of an occupancy map that stayed where it was, count as the same where the
/// two snapshots share them, as `changed` makes snapshots; what was made anew counts as another,
/// however equal. Costs what there are objects, and parts of those that changed.
SceneDifference difference(const Snapshot& before, const Snapshot& after);

}  // namespace camway::scene
