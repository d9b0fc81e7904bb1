// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/infeasibility/patch_complex.h"

namespace camway::correction {

/// Sorted, without repetition; added modulo 2.
using IndexSet = std::vector<std::uint32_t>;

/// What is in one of the two and not in both.
IndexSet sum_mod_2(const IndexSet& a, const IndexSet& b);

/// Closed surfaces of a mesh from which every other is a sum modulo 2. Depends on the mesh alone,
/// so it can be kept with the scene.
struct ClosedSurfaces {
  PatchComplex complex;
  std::vector<IndexSet> seams_of;  ///< by patch
  /// Each as patches, connected over edges. Where `complete`, every closed surface of the mesh is a
  /// sum of some of these.
  std::vector<IndexSet> surfaces;
  /// Whether the search came to its end. It is bounded because where walls meet walls everywhere,
  /// as in a solid cut into bricks, it would take time with the square of their number or more.
  bool complete = true;
};

/// Most elements of sets that are looked at while seams are eliminated: about half a second for a
/// scene, a twentieth around a point.
inline constexpr std::uint64_t kMaxEliminationSteps = 50'000'000;
inline constexpr std::uint64_t kMaxEliminationStepsNear = 5'000'000;

/// The cycles modulo 2 of the patches, by reducing the columns of their boundary matrix, smallest
/// patches first, as in the computation of persistent homology (Edelsbrunner, Letscher &
/// Zomorodian 2002, section 4). Deviation: columns are whole patches instead of triangles, rows are
/// seams instead of edges, so in a scene of separate solids nothing is left to reduce.
ClosedSurfaces find_closed_surfaces(const scene::Mesh& mesh);

/// Those among the patches that come first in `order`, as many as `max_steps` allow.
struct ReducedPatches {
  std::vector<IndexSet> surfaces;
  bool complete = true;
};
ReducedPatches reduce_patches(const PatchComplex& complex, const std::vector<IndexSet>& seams_of,
                              std::span<const std::uint32_t> order, std::uint64_t max_steps);

/// For each patch the seams that it is part of.
std::vector<IndexSet> seams_of_patches(const PatchComplex& complex);

/// The edge-connected parts of a closed surface; each is closed. In order of their lowest patch.
std::vector<IndexSet> connected_parts(const IndexSet& patches,
                                      const std::vector<IndexSet>& seams_of);

}  // namespace camway::correction
