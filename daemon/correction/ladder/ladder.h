// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/correction/infeasibility/cage.h"
#include "daemon/correction/infeasibility/separation.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/search/shut_in.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::correction {

struct LadderOptions {
  collision::DetectOptions detect;
  Objective objective = Objective::kClosest;
  OrientationPolicy orientation;
  /// For the whole path; with 0 nothing is corrected, nor looked for. [Limit: 0 <= value]
  int max_inserted_keyframes = 200;
  motion::TimeOrigin origin;  ///< of all times
  std::uint64_t seed = 1;     ///< of the search for ways round
  /// By up to which share the camera may be made smaller, about its eye: there is no path only if
  /// there is none for any such size. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// How long it takes, for each piece of the path, what is to be done with it afterwards: so much
  /// before the deadline corrections end. [Limit: 0 <= value] [Units: seconds]
  double rest_s_per_piece = 0.0;
};

struct LadderResult {
  motion::CubicPath path;
  std::vector<double> inserted_s;       ///< times of the inserted keyframes, increasing
  std::vector<Correction> corrections;  ///< one for each collision, in order
  /// A proof that there is no path at all, one or the other; looked for where the cheap ways fail.
  std::optional<Separation> separation;
  std::optional<Cage> cage;
  std::vector<ShutIn> shut_in;  ///< in the order in which that was found
  bool timed_out = false;
  /// How many inserted keyframes it would have taken where more than the limit were needed: those
  /// of the corrections that were found, all together.
  std::optional<std::size_t> needed_keyframes;
};

/// Corrects collisions one after the other, each by the first strategy that succeeds: move, turn,
/// go round (design, section 7). The costly search for ways round that need turning comes last,
/// after it was asked whether there can be any. Each changes the path by C² bumps between keyframes
/// next to the collision, so it meets all given keyframes and stays as it was elsewhere, and is
/// accepted only if all that it changed is proved free: no correction undoes another, and what
/// remains are collisions that were there before. Every strategy is bounded, so the end is certain.
///
/// `path` is the interpolation of `keyframes`, `collisions` what `detect_collisions` found on it,
/// `mesh` the scene that `obstacles` index.
LadderResult correct_by_ladder(const scene::WholeMesh& mesh, const collision::Obstacles& obstacles,
                               const motion::Body& body,
                               const std::vector<motion::Keyframe>& keyframes,
                               const motion::CubicPath& path,
                               const std::vector<collision::CollisionInterval>& collisions,
                               const LadderOptions& options, const collision::Deadline& deadline);

}  // namespace camway::correction
