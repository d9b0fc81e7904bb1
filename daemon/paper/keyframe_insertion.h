// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/path.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/paper/sweep_detection.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

struct KeyframeInsertionOptions {
  collision::SweepOptions sweep;
  motion::TimeOrigin origin;         ///< of all times
  int max_inserted_keyframes = 200;  ///< cut-off for the whole path [Limit: 0 <= value]
  int max_recursion = 8;             ///< cut-off for one interval: passes that insert into its rest
  int max_rounds = 4;                ///< how often the whole path is gone through again
};

/// What the seed's method arrived at. `keyframes` interpolate to `path`; whether that is free of
/// collision is for the caller to check.
struct KeyframeInsertionResult {
  std::vector<motion::Keyframe> keyframes;
  motion::Path path;
  int rounds = 0;
  int gave_up = 0;  ///< intervals of the last round that it could not correct
  bool timed_out = false;
};

/// The seed's correction, complete (Ptacek & Johnstone 2006, section 4): the collision intervals
/// are taken in order along the path; a keyframe is inserted at the middle `t_mid` of each, with
/// the orientation O(t_mid) and the position pushed out of the scene by `push_out`; `[t_i, t_f]` is
/// scanned again and what still collides is corrected recursively.
///
/// Deviations: collisions are with the filled near quadrilateral, so the enclosed ones that the
/// paper's sweep misses are looked for too, before each interval. An interval that cannot be
/// corrected gives back its keyframes. A keyframe that would make the camera hurry to it ten times
/// as fast as on average is refused, and each keeps a margin of ten tolerances. The new spline
/// differs from the old one beyond `[t_i, t_f]` too; therefore the path is gone through again
/// until a round finds nothing (the paper goes through it once).
///
/// Limits of the method itself, kept because it is the reference that others are measured against:
///  - no direction where no corner is bad (an object inside the quadrilateral that no segment to a
///    corner meets), where all are (a wall head-on), or where the good ones are opposite;
///  - the orientation is never changed, so a slot that needs a turn is not passed;
///  - a keyframe moves by about the depth of the collision: a way round a wall is not found;
///  - every insertion bends the whole spline; corrections can undo one another, and keyframes close
///    in time make the camera hurry and swing;
///  - cut-offs end it without telling whether a path exists.
KeyframeInsertionResult insert_keyframes(const scene::SceneIndex& index,
                                         const std::vector<motion::Keyframe>& keyframes,
                                         const motion::Corners& corners_C,
                                         const KeyframeInsertionOptions& options,
                                         const collision::Deadline& deadline);

}  // namespace camway::correction
