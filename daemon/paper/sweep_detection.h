// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/detect.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::paper {

struct SweepOptions {
  /// Largest distance of the tessellated swept surface from the true one. [Units: metres]
  double chord_error_m = 5e-3;
  /// How ends are bracketed, and how cases that the tessellation cannot decide are settled.
  collision::DetectOptions detect;
};

/// The paper's detection of the first collision interval in [t_begin_s, t_end_s] (Ptacek &
/// Johnstone 2006, section 4). The triangles of the tessellated swept surface are tested against
/// the octree in the order of their lowest parameter. `t_a` is the lowest parameter of the last
/// triangle without intersection, `t_b` the highest of the first with one; between them the near
/// quadrilateral itself is bisected. The end of the interval is found in the same way.
///
/// Deviations from the paper:
/// - The triangles between two parameters are judged together: an interval ends where none of them
///   touches the scene, not at the first triangle in the list that does not.
/// - If the middle is free, the beginning lies in the *later* half (the paper's text exchanges the
///   two branches).
/// - If `C(t_a)` and `C(t_b)` do not bracket a change, because a thin object is crossed between
///   them or only the tessellation touches it, `collision::first_collision` decides.
///
/// Does not find objects inside the swept tube that touch none of its sides; that is a gap of the
/// paper, which `collision::first_collision` closes.
collision::FirstCollision first_sweep_collision(const scene::SceneIndex& index,
                                                const motion::Path& path,
                                                const motion::Corners& corners_C, double t_begin_s,
                                                double t_end_s, const SweepOptions& options,
                                                const base::Deadline& deadline);

}  // namespace camway::paper
