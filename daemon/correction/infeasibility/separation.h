// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/closed_surfaces.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A closed surface of a scene with one point inside and another outside. A point is inside if a
/// ray from it meets the surface an odd number of times; the surface may intersect itself and need
/// not be orientable.
struct Separation {
  std::size_t inside = 0;                ///< index of a point
  std::size_t outside = 0;               ///< index of a point
  std::vector<std::uint32_t> triangles;  ///< triangles of the mesh, increasing
};

/// Looks for a closed surface of the mesh that separates some of the points.
///
/// Proof: consider the number of times, modulo 2, that a ray meets a cycle. While the origin of the
/// ray moves, the number changes only where the origin crosses the cycle (the degree modulo 2). So
/// no continuous motion moves a point from the one place to the other without touching one of the
/// triangles. That holds for every body that the point belongs to, for every rotation of the body,
/// and for every required clearance. Nothing in the proof is rounded.
///
/// `points_W`: the places of one point of the body, at each keyframe. For a camera it must be a
/// point of the filled near quadrilateral; the eye is not part of the body. `within_m`: bound of
/// the error of each point; a surface nearer than this to a point is not used for it. [Limit: 0 <=
/// value]
///
/// If `surfaces.complete`, returns nothing only in two cases: no closed surface separates two of
/// the points, or a surface of `surfaces.surfaces` that separates them is too near to one. Surfaces
/// must be closed edge for edge and bit for bit: pieces whose vertices differ by a rounding, or an
/// edge that ends in the middle of another, leave a slit, and a proof must not close slits. Of
/// several surfaces a small one is returned, not necessarily the smallest; the choice is
/// deterministic. Linear in triangles times points. Thread-safe.
std::optional<Separation> find_separation(const scene::Mesh& mesh,
                                          const scene::ClosedSurfaces& surfaces,
                                          std::span<const geometry::Vec3> points_W,
                                          double within_m);

/// Requires that `surface` separates a point of the segment `inside_W` from a point of the segment
/// `outside_W`. Returns true if it keeps clear of both segments, whose points are known to within
/// `within_m`. Then it separates every point of the one segment from every point of the other.
bool keeps_clear(const Separation& surface, const scene::Mesh& mesh,
                 const geometry::LineSegment& inside_W, const geometry::LineSegment& outside_W,
                 double within_m);

}  // namespace camway::correction
