// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "daemon/scene/import/surfaces/faceted_surface.h"

namespace camway::scene::cad {

/// A part whose error would take more triangles than this is not made finer: the library takes ten
/// seconds for so many, and its time grows faster than their number.
inline constexpr std::size_t kMostPartTriangles = 300'000;

/// A part as triangles, in millimetres.
struct PartMesh {
  surfaces::FacetedSurface facets;                ///< equal points are one
  std::uint64_t faces = 0;                        ///< that became triangles
  std::map<std::string, std::uint64_t> left_out;  ///< faces that did not, by the reason
};

/// Makes triangles of a part's faces. The library proposes them (`BRepMesh_IncrementalMesh`), and
/// sides that slide are split (`surfaces::refine_sides`). The error is not the library's word, but
/// derived of the exact surfaces (`surfaces::error_of`), to which come the distances of trim curves
/// from their edges, as the library states them. The proposal becomes finer until the error is
/// within `kRelativeTolerance` of half the diagonal of the part, or finer triangles do not lessen
/// it, or that would take more than `kMostPartTriangles`.
///
/// The bound counts how far a triangle slides along its surface, too. The library does not, and
/// puts only two nodes on an edge that is straight in space. So sides are split where parameters
/// run unevenly, as with weights that differ much and at the apex of a cone.
///
/// Surfaces become rational B-splines first, which is exact for all that `fault_of_form` accepts;
/// faces of others are left out, as are faces whose triangles have no bound. Neighbouring faces
/// share the points of their edges, so that they do not gape, where the file says that they share
/// these. Throws what the library throws.
PartMesh mesh_of_part(const TopoDS_Shape& part);

}  // namespace camway::scene::cad
