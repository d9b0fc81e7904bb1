// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/collision/query.h"
#include "daemon/correction/infeasibility/cage.h"
#include "daemon/correction/infeasibility/separation.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/search/shut_in.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::correction {

struct LadderOptions {
  Objective objective = Objective::kClosest;
  OrientationPolicy orientation;
  /// Limit for the whole path; 0 corrects nothing and searches nothing. [Limit: 0 <= value]
  int max_inserted_keyframes = 0;
  motion::TimeOrigin origin;  ///< origin of all times
  /// Viewing distance of the cost of corrections (`closeness.h`); 0 takes it from the scene.
  /// [Limit: 0 <= value]
  double viewing_distance_m = 0.0;
  std::uint64_t seed = 1;  ///< random seed of searches for detours
  /// Largest share by which the camera may shrink about its eye. A proof that there is no path must
  /// hold for every such size. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// Time per piece of the path that is needed after the corrections; they end so much before the
  /// deadline. [Limit: 0 <= value] [Units: seconds]
  double rest_s_per_piece = 0.0;
};

struct LadderResult {
  motion::CubicPath path;
  std::vector<double> inserted_s;       ///< times of the inserted keyframes, increasing
  std::vector<Correction> corrections;  ///< one for each collision, in order of time
  /// At most one of the two is set: a proof that there is no path at all. Proofs are attempted
  /// where the cheap methods fail.
  std::optional<Separation> separation;
  std::optional<Cage> cage;
  /// Keyframes found to be shut in, in the order of discovery; first those of which everything that
  /// is reachable was searched.
  std::vector<ShutIn> shut_in;
  Closeness closeness;  ///< the scale by which corrections were compared
  bool timed_out = false;
  /// Whether polishing found a path that is better by another objective than `kClosest`.
  bool is_polished = false;
  /// If the limit was exceeded: the number of inserted keyframes that all corrections found would
  /// need.
  std::optional<std::size_t> needed_keyframes;
};

/// Corrects collisions one after the other: by a move, else by a detour that keeps the orientation
/// or by a turn, whichever costs less (`closeness.h`). The costly search for detours through
/// narrow places comes last, after an attempt to prove that there is no path.
///
/// A correction changes the path by C² bumps between keyframes next to the collision, so the path
/// meets all given keyframes and stays as it was elsewhere. It is accepted only if all that it
/// changed is proved free, so no correction undoes another, and remaining collisions were there
/// before. Every method has a bounded number of steps.
///
/// Requires `path` to be the interpolation of `keyframes`, `collisions` the result of
/// `detect_collisions(query, ...)` on it, and `mesh` the scene that `query.obstacles` index.
LadderResult correct_by_ladder(const scene::WholeMesh& mesh, const collision::Query& query,
                               const std::vector<motion::Keyframe>& keyframes,
                               const motion::CubicPath& path,
                               const std::vector<collision::CollisionInterval>& collisions,
                               const LadderOptions& options, const base::Deadline& deadline);

}  // namespace camway::correction
