// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/mesh/closed_surfaces.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::correction {

/// Decides on which side of each closed surface of a mesh a point is, by one ray per point.
/// Thread-safe.
class SurfaceSides {
 public:
  /// Refers to `mesh` and `index`, which must outlive it. Requires `index` to index `mesh`.
  SurfaceSides(const scene::WholeMesh& mesh, const scene::SceneIndex& index);

  /// Returns the closed surfaces that enclose the point, as indices into `ClosedSurfaces::surfaces`
  /// of the mesh. A surface encloses the point if a ray from the point meets it an odd number of
  /// times. Surfaces that `ClosedSurfaces` did not find enclose nothing. Returns nothing if the
  /// point is found to be on a triangle. The set is the same at both ends of any motion that does
  /// not touch the scene.
  [[nodiscard]] std::optional<scene::IndexSet> around(const geometry::Vec3& point_W) const;

 private:
  const scene::Mesh& mesh_;
  const scene::SceneIndex& index_;
  std::vector<std::uint32_t> patch_of_;       ///< patch of each triangle, or kNoIndex
  std::vector<scene::IndexSet> surfaces_of_;  ///< surfaces of each patch
};

}  // namespace camway::correction
