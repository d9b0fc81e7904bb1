// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// The difference of two revisions of a scene. Every triangle of the later one is in `index`, or is
/// in the earlier one in the same place. The same holds of solids.
struct SceneDifference {
  /// Triangles that the later revision has and the earlier one has not, or has elsewhere.
  SceneIndex index;
  std::shared_ptr<const SceneSolids> solids;  ///< null if none of these has an inside
  /// Boxes, of objects or of changed regions of an occupancy map, that hold all triangles of
  /// `index` and all space in `solids` that was not solid before.
  std::vector<geometry::Box> added;
  /// Boxes of what the earlier revision has and the later one has not, or has elsewhere.
  std::vector<geometry::Box> removed;

  bool other_bounds = false;  ///< whether the bounds that bodies must not leave differ

  [[nodiscard]] bool empty() const { return added.empty() && removed.empty() && !other_bounds; }
};

/// Computes the difference. Objects are equal, and so are bricks of an occupancy map that was not
/// moved, if the two snapshots share them, as those made by `changed` do; rebuilt ones count as
/// different. The cost depends on the number of objects, and of bricks in those that differ.
SceneDifference difference(const Snapshot& before, const Snapshot& after);

}  // namespace camway::scene
