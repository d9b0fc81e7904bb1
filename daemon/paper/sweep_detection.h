// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/detect.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::collision {

struct SweepOptions {
  /// How far the tessellated swept surface may stray from the true one. [Units: metres]
  double chord_error_m = 5e-3;
  DetectOptions
      detect;  ///< how ends are bracketed, and how what tessellation cannot tell is settled
};

/// The seed's detection of the first collision interval in [t_begin_s, t_end_s]
/// (Ptacek & Johnstone 2006, section 4): the triangles of the tessellated swept surface are tested
/// against the octree in the order of their lowest parameter. `t_a` is the lowest parameter of the
/// last triangle without intersection, `t_b` the highest of the first with one; the near
/// quadrilateral itself is bisected between them. The end of the interval likewise.
///
/// Deviations from the paper:
///  - the triangles between two parameters are judged together: an interval ends where none of them
///    touches the scene, not where the next in the list happens not to;
///  - if the middle is free, the beginning lies in the *later* half (the paper's text exchanges the
///    two branches);
///  - where `C(t_a)` and `C(t_b)` do not bracket a change, because a thin object is crossed between
///    them or only the tessellation touches it, `first_collision` decides.
/// Objects inside the swept tube that touch none of its sides are not found here: that is the
/// paper's gap, which `first_collision` closes.
FirstCollision first_sweep_collision(const scene::SceneIndex& index, const motion::Path& path,
                                     const motion::Corners& corners_C, double t_begin_s,
                                     double t_end_s, const SweepOptions& options,
                                     const Deadline& deadline);

}  // namespace camway::collision
