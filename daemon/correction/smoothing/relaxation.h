// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// What paths are improved for, and how much effort is left for it: steps, each of which costs
/// about as much as a hundred questions to the scene.
struct Improvement {
  Objective objective = Objective::kClosest;
  int steps_left = 0;
  bool may_turn = true;     ///< else orientations stay as they are, whatever the request allows
  double spread = kSpread;  ///< of `SmoothingForm`
  double worth = 0.1;       ///< share of the objective that polishing has to promise
};

/// A correction that is proved free: `problem.path` with `bumps_for(offsets, ends)`.
struct Relaxed {
  Offsets offsets;
  Candidate candidate;
};

/// Improves a free correction under an objective (`SmoothingForm`), and keeps it free: steps to
/// where the objective is least while the body keeps, to first order, out of the scene next to it,
/// as in sequential convex optimisation (Schulman et al. 2013, "Finding locally optimal,
/// collision-free trajectories with sequential convex optimization"), no further than it is free at
/// sampled times. Deviation: what is free to begin with stays free, so contacts bound steps instead
/// of costing something. The result is proved, and where something slips through between the
/// samples, it is taken back there, and sampled; in the end to what it began with, and so where it
/// came out worse. For `kSafest` missing gaps cost something besides (`ContactBounds`).
Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, Improvement& improvement,
                FreeSpace& space, const collision::Deadline& deadline);

/// Improves what lies between the two keyframes of the gap, and a little beyond, of a path that is
/// free already, by a row of bumps on that many knots. Nothing where nothing better was found.
/// [Limit: knots >= 4]
std::optional<Candidate> polished(const Problem& problem, int knots, Improvement& improvement,
                                  FreeSpace& space, const collision::Deadline& deadline);

}  // namespace camway::correction
