// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"
#include "tools/drawing/floor_section.h"

namespace camway::draw {

/// A surface that no motion passes, and the two keyframes that it separates: the proof of an answer
/// that there is no path.
struct Barrier {
  scene::Mesh surface;               ///< the closed surface, or the box of a cage
  std::size_t keyframe_inside = 0;   ///< number of a given keyframe, as in messages
  std::size_t keyframe_outside = 0;  ///< number of another one
};

/// Returns the barrier of a proof. `mesh` is that of the scene; triangles that it does not have are
/// left out.
Barrier barrier_of(const planning::Infeasibility& proof, const scene::Mesh& mesh);

/// Returns the section of a barrier for the section of a storey: at its height, or at the height of
/// the barrier that is nearest to it, between floor and cut. Empty where the barrier is on other
/// storeys.
std::vector<SectionLine> barrier_section(const Barrier& barrier, SceneUp up,
                                         const FloorSection& storey);

}  // namespace camway::draw
