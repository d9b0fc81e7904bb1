// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// The difference of two revisions of a scene, an earlier and a later one. Every triangle of the
/// later revision is in `index`, or is in the same place in the earlier revision. Every solid of
/// the later revision is in `solids`, or is in the same place in the earlier revision.
struct SceneDifference {
  /// Triangles of the later revision that the earlier revision does not have in the same place.
  SceneIndex index;
  std::shared_ptr<const SceneSolids> solids;  ///< null if nothing that was added has an inside
  /// Boxes, of objects or of changed regions of an occupancy map, that hold all triangles of
  /// `index` and all space in `solids` that was not solid before.
  std::vector<geometry::Box> added;
  /// Boxes of everything in the earlier revision that the later revision does not have in the same
  /// place.
  std::vector<geometry::Box> removed;

  bool other_bounds = false;  ///< whether the bounds that bodies must not leave differ
  /// Bound of how far smooth surfaces of the later revision are from its triangles.
  double surface_error_m = 0.0;
  bool is_coarser = false;  ///< whether that is more than in the earlier revision

  [[nodiscard]] bool empty() const {
    return added.empty() && removed.empty() && !other_bounds && !is_coarser;
  }
};

/// Computes the difference. Two objects count as equal if the two snapshots share them, as
/// snapshots made by `changed` do. The same holds for bricks of an occupancy map that was not
/// moved. Objects and bricks that were rebuilt count as different. The cost depends on the number
/// of objects, and on the number of bricks of the objects that differ.
SceneDifference difference(const Snapshot& before, const Snapshot& after);

}  // namespace camway::scene
