// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/infeasibility/cage_box.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/closed_surfaces.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A box whose faces are closed except for holes that are too narrow for a flat body. It separates
/// two points.
struct Cage {
  std::size_t inside = 0;   ///< index of the point inside the box
  std::size_t outside = 0;  ///< index of the point outside
  CageBox box;
  /// Triangles that the proof uses, of closed surfaces and in the planes of faces; increasing.
  std::vector<std::uint32_t> triangles;
};

/// Looks for a cage that the centre of a flat convex body cannot leave. A cage is parallel to the
/// axes of the world, or to those of a frame that is turned about one of them (`CageScene`).
/// Returns nothing if it finds none. `centers_W`: the centre at each keyframe, known to within
/// `within_m`. `shortest_chord_m`: the shortest chord through the centre; for a rectangle its
/// smaller side [Limit: 0 < value].
///
/// Proof that the centre cannot leave. The body never leaves its side of a closed surface and never
/// touches a triangle. A place on a face is *blocked* if it is on the other side of a closed
/// surface than the body, or if a triangle in the plane of the face covers it. A *hole* is a
/// connected part of a face that is not blocked. So every point of the body on a face is in a hole.
/// In a cage, a hole may reach the border of its face only where the adjacent face is blocked at
/// that border. So the body never meets an edge of the box. Suppose that the centre is on a face.
/// The section of the body with the plane of the face is then a chord through the centre, or the
/// whole body if the body lies in the plane. The section is connected, contains a chord through the
/// centre, and has no point on the border of the face. So the chord lies in the face, and in one
/// hole. But the chord is longer than the hole is wide: a contradiction. So the centre is never on
/// a face, in whatever orientation.
///
/// All rounding is to the safe side. The map to a turned frame, with the sine and cosine as
/// computed, is exactly a rotation and a scaling. The scale differs from 1 by a few roundings.
/// `kChordRounding` (cage.cpp) covers these and the rounding of the body's sides. Each vertex as
/// computed is within `margin_m` (`CageScene`) of its exact image. Imagine that all vertices move
/// straight from the computed to the exact places. Meanwhile no triangle touches an element of a
/// face (`FaceGrid`) that it did not mark. No triangle touches the centre inside the box either: a
/// parity is used only if the centre is farther from every triangle of the surface than the
/// vertices move and the centre is uncertain. So each computed side is the side for the exact
/// vertices. Both centres are farther from the faces of the box than their uncertainty. Widths are
/// rounded up.
///
/// Never claims a cage wrongly. May miss a cage, for example:
/// - if a bar is parallel to no axis of the frames above;
/// - if a bar is not a closed surface;
/// - if an even number of different triangles of one surface, or of none, cover the same place in
///   the plane of a face, as where a mesh divides a floor in two ways.
///
/// Bounded in time. Thread-safe.
std::optional<Cage> find_cage(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                              std::span<const geometry::Vec3> centers_W, double shortest_chord_m,
                              double within_m);

}  // namespace camway::correction
