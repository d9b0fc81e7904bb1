// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/infeasibility/patch_complex.h"

namespace camway::correction {

/// A set of indices, sorted, without repetition; a vector over the integers modulo 2.
using IndexSet = std::vector<std::uint32_t>;

/// Symmetric difference.
IndexSet sum_mod_2(const IndexSet& a, const IndexSet& b);

/// Closed surfaces of a mesh that generate all others by sums modulo 2. Depends on the mesh alone,
/// so it can be kept with the scene.
struct ClosedSurfaces {
  PatchComplex complex;
  std::vector<IndexSet> seams_of;  ///< seams of each patch
  /// The surfaces, each a set of patches that is connected over edges. If `complete`, every closed
  /// surface of the mesh is a sum of some of these.
  std::vector<IndexSet> surfaces;
  /// Whether the search finished. It is bounded because it takes quadratic time or more where walls
  /// meet walls everywhere, as in a solid cut into bricks.
  bool complete = true;
};

/// Largest number of set elements visited while seams are eliminated: about half a second for a
/// scene, a twentieth of a second around a point.
inline constexpr std::uint64_t kMaxEliminationSteps = 50'000'000;
inline constexpr std::uint64_t kMaxEliminationStepsNear = 5'000'000;

/// Finds the cycles of the patches modulo 2 by reducing the columns of their boundary matrix,
/// smallest patches first, as in the computation of persistent homology (Edelsbrunner, Letscher &
/// Zomorodian 2002, section 4). Deviation: columns are whole patches instead of triangles, rows are
/// seams instead of edges; in a scene of separate solids nothing is left to reduce.
ClosedSurfaces find_closed_surfaces(const scene::Mesh& mesh);

/// Closed surfaces among the patches that come first in an order.
struct ReducedPatches {
  std::vector<IndexSet> surfaces;
  bool complete = true;
};
/// Reduces patches in the order of `order` until `max_steps` elements were visited.
ReducedPatches reduce_patches(const PatchComplex& complex, const std::vector<IndexSet>& seams_of,
                              std::span<const std::uint32_t> order, std::uint64_t max_steps);

/// Returns for each patch the seams that contain it.
std::vector<IndexSet> seams_of_patches(const PatchComplex& complex);

/// The edge-connected parts of a closed surface, each of them closed, in order of their lowest
/// patch.
std::vector<IndexSet> connected_parts(const IndexSet& patches,
                                      const std::vector<IndexSet>& seams_of);

}  // namespace camway::correction
