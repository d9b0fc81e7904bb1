// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::view {

/// How far a displayed vertex may be from that of the mesh. It decides how many bytes a mesh takes.
/// Small objects are finer, and those of more than ten kilometres coarser. [Units: metres]
inline constexpr double kDisplayError_m = 1e-3;

/// A mesh to be looked at, on a grid about its centre. No proof: it may be simplified.
struct DisplayMesh {
  using GridPoint = std::array<std::int32_t, 3>;

  geometry::Vec3 centre_O = geometry::Vec3::Zero();  ///< of the bounding box
  double step_m = 1.0;                               ///< of the grid
  std::vector<GridPoint> vertices;                   ///< in steps from the centre, each once
  std::vector<std::uint32_t> indices;                ///< three for each triangle shown
  std::size_t triangles = 0;                         ///< of the mesh that this shows
  bool is_simplified = false;
  /// How far vertices were moved to the grid; and for a simplified mesh what its simplifier
  /// estimates beside that, which is no bound. [Units: metres]
  double error_m = 0.0;

  [[nodiscard]] std::size_t shown() const { return indices.size() / 3; }
};

/// Makes a mesh that is looked at, of about `most_triangles` at most: it may exceed that by a
/// quarter. Triangles that have less than three different corners on the grid are left out. The
/// same for the same mesh. The order of triangles and vertices is one that compresses well.
DisplayMesh display_mesh(const scene::Mesh& mesh_O, std::size_t most_triangles);

}  // namespace camway::view
