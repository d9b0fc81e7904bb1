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

/// A box whose faces are closed but for holes too narrow for a flat body, with one point inside and
/// another outside.
struct Cage {
  std::size_t inside = 0;   ///< index of a point
  std::size_t outside = 0;  ///< index of a point
  CageBox box;
  /// Of the closed surfaces, and those in the planes of faces, that were looked at, increasing.
  std::vector<std::uint32_t> triangles;
};

/// Looks for a cage that the centre of a flat convex body cannot leave: a box parallel to the axes
/// of the world, or of a frame turned about one of them (`CageScene`). `centers_W`: where the
/// centre is at one keyframe after the other, known to `within_m`. `shortest_chord_m`: of those
/// through the centre; the smaller side of a rectangle [Limit: 0 < value].
///
/// Why there is no way out. A body that is on one side of a closed surface stays there, and it is
/// never on a triangle. So on a face of the box it can be only in what neither the other sides of
/// surfaces nor triangles in its plane fill. If that nowhere reaches the face's border, but where
/// the face beside it is filled, the body never meets an edge of the box. Let its centre be on a
/// face. In the plane of the face the body is a chord through the centre, or all of it; connected,
/// without a point on the border, so all of that chord lies in the face, and in one hole. But it is
/// longer than the hole is wide. So the centre is never on a face, however the body turns.
///
/// What is rounded falls to the safe side. A turned frame is exactly a rotation and a scaling by 1
/// but for a few roundings, which `kChordRounding` covers, like those of the body's sides. Where
/// its vertices are only `margin_m` is known of; moved from there to where they are exactly, no
/// triangle meets what it is not marked to touch (`FaceGrid`), nor the centre inside, which is
/// further than that from all of a surface whose sides are told: so sides are what they are for
/// exact vertices. Both centres are off the box by more than they are unknown. Widths are rounded
/// up.
///
/// So a cage is never claimed wrongly, but missed where bars are parallel to no such axes, are not
/// closed surfaces, or are there twice on a floor. Bounded in time; safe from any thread.
std::optional<Cage> find_cage(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                              std::span<const geometry::Vec3> centers_W, double shortest_chord_m,
                              double within_m);

}  // namespace camway::correction
