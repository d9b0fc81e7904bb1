// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/cage_box.h"
#include "daemon/correction/closed_surfaces.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh.h"

namespace camway::correction {

/// A box whose faces are closed but for holes too narrow for a flat body, with one point inside and
/// another outside.
struct Cage {
  std::size_t inside = 0;   ///< index of a point
  std::size_t outside = 0;  ///< index of a point
  CageBox box;
  /// Of the bars, which are closed surfaces: their triangles that were needed, increasing.
  std::vector<std::uint32_t> triangles;
};

/// Looks for a cage of separate closed bars, parallel to the axes, that the centre of a flat convex
/// body cannot leave. `centers_W`: where that is at one keyframe after the other, known to
/// `within_m`. `shortest_chord_m`: of those through the centre; the smaller side of a rectangle
/// [Limit: 0 < value].
///
/// Why there is no way out. A body that is outside a bar, which is a closed surface, stays outside.
/// So on a face of the box it can be only in what no bar fills, and if that nowhere reaches the
/// face's border, the body never meets an edge of the box. Let its centre be on a face. In the
/// plane of the face the body is a chord through the centre, or all of it; connected, without a
/// point on the border, so all of that chord lies in the face, and in one hole. But it is longer
/// than the hole is wide. So the centre is never on a face, however the body turns.
///
/// The holes are measured on a grid (`FaceGrid`), rounded to the safe side, so it is never claimed
/// wrongly, but missed where bars are not parallel to the axes, are not closed surfaces each of its
/// own, or do not cover the edges of the box. Bounded in time; safe from any thread.
std::optional<Cage> find_cage(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                              std::span<const geometry::Vec3> centers_W, double shortest_chord_m,
                              double within_m);

}  // namespace camway::correction
