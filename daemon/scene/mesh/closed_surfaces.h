// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/scene/mesh/patch_complex.h"

namespace camway::scene {

/// A set of indices, sorted, without repetition; a vector over the integers modulo 2.
using IndexSet = std::vector<std::uint32_t>;

/// Symmetric difference.
IndexSet sum_mod_2(const IndexSet& a, const IndexSet& b);

/// Closed surfaces of a mesh. Their sums modulo 2 are all closed surfaces of the mesh, if
/// `complete`. The value depends on the mesh alone; `WholeMesh` keeps that of a scene.
struct ClosedSurfaces {
  PatchComplex complex;
  std::vector<IndexSet> seams_of;  ///< seams of each patch
  /// The surfaces, each a set of patches that is connected over edges. If `complete`, every closed
  /// surface of the mesh is a sum of some of these.
  std::vector<IndexSet> surfaces;
  /// Whether the search finished within `kMaxEliminationSteps`. The search has this limit because
  /// it takes quadratic time or more in scenes where walls meet walls everywhere, such as a solid
  /// cut into bricks.
  bool complete = true;
};

/// Largest number of set elements that the elimination of seams visits, for a whole scene: about
/// half a second.
inline constexpr std::uint64_t kMaxEliminationSteps = 50'000'000;
/// The same limit for a search around one point: about a twentieth of a second.
inline constexpr std::uint64_t kMaxEliminationStepsNear = 5'000'000;

/// Finds the cycles of the patches modulo 2 by reducing the columns of their boundary matrix,
/// smallest patches first, as in the computation of persistent homology (Edelsbrunner, Letscher &
/// Zomorodian 2002, section 4). Deviation: columns are whole patches instead of triangles, and rows
/// are seams instead of edges. So in a scene of separate solids nothing is left to reduce.
ClosedSurfaces find_closed_surfaces(const Mesh& mesh);

/// Result of `reduce_patches`: the closed surfaces that consist of the patches that it reached.
struct ReducedPatches {
  std::vector<IndexSet> surfaces;
  bool complete = true;  ///< whether it reached all patches of the order
};
/// Adds the patches one by one, in the order of `order`, to the reduction of
/// `find_closed_surfaces`. Stops before a patch whose reduction would exceed `max_steps` visited
/// set elements.
ReducedPatches reduce_patches(const PatchComplex& complex, const std::vector<IndexSet>& seams_of,
                              std::span<const std::uint32_t> order, std::uint64_t max_steps);

/// Returns for each patch the seams that contain it.
std::vector<IndexSet> seams_of_patches(const PatchComplex& complex);

/// Returns the edge-connected parts of a closed surface, in order of their lowest patch. Each part
/// is closed.
std::vector<IndexSet> connected_parts(const IndexSet& patches,
                                      const std::vector<IndexSet>& seams_of);

}  // namespace camway::scene
