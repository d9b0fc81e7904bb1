// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/path.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/paper/sweep_detection.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::paper {

struct KeyframeInsertionOptions {
  SweepOptions sweep;
  motion::TimeOrigin origin;         ///< origin of all times
  int max_inserted_keyframes = 200;  ///< limit for the whole path [Limit: 0 <= value]
  /// Limit of the depth of recursion within one collision interval. [Limit: 0 <= value]
  int max_recursion = 8;
  int max_rounds = 4;  ///< limit of passes over the whole path [Limit: 0 <= value]
};

/// Result of the paper's method. `path` interpolates `keyframes`. It may still collide: the caller
/// must check it.
struct KeyframeInsertionResult {
  std::vector<motion::Keyframe> keyframes;
  motion::Path path;
  int rounds = 0;          ///< whole passes over the path that corrected an interval
  int gave_up = 0;         ///< intervals that the last pass could not correct
  bool timed_out = false;  ///< the deadline struck before the last pass ended
};

/// The paper's correction (Ptacek & Johnstone 2006, section 4). Takes the collision intervals in
/// order along the path; inserts a keyframe at the middle `t_mid` of each, with the orientation
/// O(t_mid) and the position pushed out of the scene by `push_out`; checks `[t_i, t_f]` again and
/// corrects the remaining collisions recursively.
///
/// Deviations:
/// - Collisions are those of the filled near quadrilateral. Before each interval that the paper's
///   sweep finds, the distance-based detection searches for enclosed objects that the sweep misses.
/// - An interval that cannot be corrected loses its inserted keyframes.
/// - A keyframe that needs ten times the average speed or more is refused.
/// - Each inserted keyframe keeps ten times the tolerance of detection from the scene.
/// - The new spline differs from the old one beyond `[t_i, t_f]` too, so the path is checked again
///   until a round corrects nothing (the paper checks it once).
///
/// Limits of the method itself, kept because it is the reference for comparison:
/// - It has no direction if no corner is bad (an object inside the quadrilateral that no segment to
///   a corner meets), if all are (a wall head-on), or if the good ones are opposite.
/// - It never changes the orientation, so it cannot pass a slot that needs a turn.
/// - A keyframe moves by about the depth of the collision: it finds no way round a wall.
/// - Every insertion bends the whole spline; corrections can undo one another, and keyframes close
///   in time make the camera hurry and swing.
/// - Its limits end it without telling whether a path exists.
KeyframeInsertionResult insert_keyframes(const scene::SceneIndex& index,
                                         const std::vector<motion::Keyframe>& keyframes,
                                         const motion::Corners& corners_C,
                                         const KeyframeInsertionOptions& options,
                                         const base::Deadline& deadline);

}  // namespace camway::paper
