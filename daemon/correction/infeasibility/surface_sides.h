// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/correction/infeasibility/closed_surfaces.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// Tells on which side of the closed surfaces of a mesh points are, at the cost of a ray for each
/// point. What no closed surface encloses, or none that was found, counts as outside. Safe from
/// several threads at once.
class SurfaceSides {
 public:
  /// Refers to `mesh` and `index`, which indexes it; both must outlive it.
  SurfaceSides(const scene::Mesh& mesh, const scene::SceneIndex& index);

  /// The closed surfaces, by a number of their own, that the point is inside of: where a ray from
  /// it meets them an odd number of times. Nothing if it is seen to be on a triangle. What moves
  /// from one point to another without touching the scene has the same set at both.
  [[nodiscard]] std::optional<IndexSet> around(const geometry::Vec3& point_W) const;

 private:
  const scene::Mesh& mesh_;
  const scene::SceneIndex& index_;
  std::vector<std::uint32_t> patch_of_;  ///< by triangle, or kNoIndex
  std::vector<IndexSet> surfaces_of_;    ///< by patch
};

}  // namespace camway::correction
