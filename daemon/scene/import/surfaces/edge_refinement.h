// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "daemon/scene/import/surfaces/knot_axis.h"
#include "daemon/scene/import/surfaces/parametric_error.h"

namespace camway::scene::surfaces {

/// A piece of an edge of a part; faces that meet at the edge have the same pieces. `number` counts
/// the pieces between the edge's first nodes. `path` is 1 for such a piece, and 2 p and 2 p + 1 for
/// the first and second half of the piece with path p.
struct EdgePiece {
  std::uint32_t edge = 0;
  std::uint32_t number = 0;
  std::uint64_t path = 1;

  auto operator<=>(const EdgePiece&) const = default;
};

/// The origin of a piece of a face's boundary.
struct BoundarySource {
  std::optional<EdgePiece> piece;  ///< empty if the piece must not be split
  std::size_t curve = 0;           ///< index into `RefinableFace::curves`
  double from = 0.0;               ///< parameter of the edge at the first node of the `TrimPiece`
  double to = 0.0;                 ///< and at the second, which may be less
};

/// A face whose triangles can be refined.
struct RefinableFace {
  ParametricSurface surface;
  ParametricMesh mesh;
  std::vector<PlaneCurve> curves;       ///< trim curves, by the parameters of their edges
  std::vector<BoundarySource> sources;  ///< of each piece of `mesh.boundary`
};

/// Returns the point of an edge (`EdgePiece::edge`) at a parameter.
using EdgePoints = std::function<Point(std::uint32_t edge, double parameter)>;

/// Splits sides of triangles in the middle until no side slides or sags by more than `tolerance`.
///
/// A side with nodes P_i, P_j and parameters v_i, v_j *slides* by the largest of
/// |S((1 - f) v_i + f v_j) - ((1 - f) P_i + f P_j)| for f = 1/4, 1/2 and 3/4, less the distance of
/// its nodes from S, which no split lessens. `error_of` counts this, along the surface and across
/// it. A program that makes triangles of a face may look across alone: it puts no node on an edge
/// that is straight in space, though the parameters of the edge may run unevenly. A piece of the
/// boundary *sags* by `sag_of`.
///
/// A side inside of a face is split at the middle of its parameters, by a node on S. A piece of an
/// edge is split at the middle of its own parameters, in all faces that have it, if it slides or
/// sags in one of them. The node is the same point of the edge in each face, and its parameters are
/// those of the face's trim curve. So faces that share their nodes still do. A triangle with split
/// sides becomes two, three or four triangles; of the ways to divide it, the one whose new sides
/// slide the least is taken.
///
/// A side is not split if a triangle beside it would turn over in (u, v), since trim curves are not
/// straight, or if faces have different nodes for its edge. Faces with surfaces that have a fault
/// (`fault_of`), and faces whose triangles and boundary do not fit each other, stay as they are.
/// Stops early before the faces have more than `most_triangles` in all. The outline of each face
/// stays its boundary. Requires indices that exist.
void refine_sides(std::span<RefinableFace* const> faces, const EdgePoints& edges, double tolerance,
                  std::size_t most_triangles);

}  // namespace camway::scene::surfaces
