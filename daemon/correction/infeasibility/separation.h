// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/infeasibility/closed_surfaces.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A closed surface of a scene with one point inside and another outside. Inside is where a ray
/// meets it an odd number of times; the surface may pass through itself and need have no
/// orientation.
struct Separation {
  std::size_t inside = 0;                ///< index of a point
  std::size_t outside = 0;               ///< index of a point
  std::vector<std::uint32_t> triangles;  ///< of the mesh, increasing
};

/// Looks for a closed surface of the mesh that separates some of the points.
///
/// Modulo 2, the number of times that a ray meets a cycle changes only where its origin crosses the
/// cycle (the degree modulo 2). So no continuous motion takes something from the one point to the
/// other without touching one of the triangles: whatever it is a part of, however that turns, and
/// whatever clearance it has to keep. Nothing in this is rounded.
///
/// `points_W`: where the same point of the moving body is at one keyframe after the other. For a
/// camera that is a point of the filled near quadrilateral, not the eye, which is no part of it.
/// `within_m`: how far from there it may really be, at any of them, for rounding; surfaces so near
/// to a point do not count for it. [Limit: >= 0]
///
/// Where `surfaces.complete`, nothing is found only if no closed surface separates two of the
/// points, or one of `surfaces.surfaces` that does is too near to them. What is not closed, edge
/// for edge and bit for bit, is never found: two pieces whose vertices differ by a rounding, or an
/// edge that ends in the middle of another, leave a slit, and a proof must not close slits. Of
/// several surfaces it is a small one, not surely the smallest; always the same. Linear in
/// triangles times points; safe from any thread.
std::optional<Separation> find_separation(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                                          std::span<const geometry::Vec3> points_W,
                                          double within_m);

/// Whether the surface also separates all points of the one segment, each known to `within_m`, from
/// all of the other, if it separates some: whether it keeps clear of both.
bool keeps_clear(const Separation& surface, const scene::Mesh& mesh,
                 const geometry::LineSegment& inside_W, const geometry::LineSegment& outside_W,
                 double within_m);

}  // namespace camway::correction
