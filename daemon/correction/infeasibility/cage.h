// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/infeasibility/cage_box.h"
#include "daemon/correction/infeasibility/closed_surfaces.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A box with closed faces, except for holes that are too narrow for a flat body, with one point
/// inside and another outside.
struct Cage {
  std::size_t inside = 0;   ///< index of a point
  std::size_t outside = 0;  ///< index of a point
  CageBox box;
  /// Triangles of the closed surfaces and of the faces' planes that were used, increasing.
  std::vector<std::uint32_t> triangles;
};

/// Looks for a cage that the centre of a flat convex body cannot leave: a box parallel to the axes
/// of the world, or of a frame turned about one of them (`CageScene`). `centers_W`: the centre at
/// each keyframe, known to within `within_m`. `shortest_chord_m`: the shortest chord through the
/// centre; for a rectangle its smaller side [Limit: 0 < value].
///
/// Proof that there is no way out: a body stays on its side of a closed surface and is never on a
/// triangle. So on a face of the box it can be only in *holes*, which neither the other sides of
/// surfaces nor triangles in the plane fill. In a cage no hole reaches the border of its face,
/// except where the adjacent face is filled; so the body never meets an edge of the box. Suppose
/// that the centre is on a face. The body meets the plane of the face in a chord through the centre
/// or lies in it, and then contains such a chord. That section is connected and has no point on the
/// border, so the chord lies in the face and in one hole. But it is longer than the hole is wide.
/// So the centre is never on a face, however the body turns.
///
/// All rounding is to the safe side. A turned frame is exactly a rotation and a scaling by 1, up to
/// a few roundings, which `kChordRounding` covers, like those of the body's sides. Vertices in it
/// are known to within `margin_m`. While vertices move from there to their exact places, no
/// triangle meets an element that it does not mark (`FaceGrid`), nor the centre inside: parities
/// are used only where it is farther than that from the whole surface. So sides are those of the
/// exact vertices. Both centres are farther from the faces of the box than their uncertainty.
/// Widths are rounded up.
///
/// Never claims a cage wrongly. Misses cages whose bars are parallel to no such axes, are not
/// closed surfaces, or occur twice on a floor. Bounded in time. Thread-safe.
std::optional<Cage> find_cage(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                              std::span<const geometry::Vec3> centers_W, double shortest_chord_m,
                              double within_m);

}  // namespace camway::correction
