// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/base/budget.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/improvement.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// A correction that is proved free: `problem.path` plus `bumps_for(offsets, ends)`.
struct Relaxed {
  Offsets offsets;
  Candidate candidate;
  int paths = 0;  ///< changed paths that the relaxation checked for collisions
};

/// Returns a free correction that is better by an objective (`SmoothingForm`) than the correction
/// `free`. Spends steps of `budget`; each costs about as much as a hundred distance queries.
///
/// Sequential convex optimisation (Schulman et al. 2013, "Finding locally optimal, collision-free
/// trajectories with sequential convex optimization"): each step goes to the minimum of the
/// objective subject to linearised contacts, but no farther than the body is free at sampled times.
/// Deviation: the path is free from the start and stays so, so contacts are constraints of the
/// steps instead of penalties; only `kSafest` also penalises missing gaps (`ContactBounds`).
/// Steps towards the closest path weigh acceleration more than the cost does, which decides what is
/// accepted.
///
/// The result is proved. If the path collides between the samples, samples are added there, the
/// change is reverted as far as needed, and a few more steps are taken, beside those of `budget`.
/// Returns `free` if no proof succeeds or the objective became worse. Exception: with `kClosest`
/// and `makes_room` the cost may grow by a quarter.
Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, const Improvement& improvement,
                base::Budget& budget, FreeSpace& space, const base::Deadline& deadline);

/// Improves a free path by a row of bumps on `knots` steps, from before the first to after the
/// second keyframe of the problem's interval. Returns nothing if no better path was found. Spends
/// steps of `budget`. [Limit: knots >= 4]
std::optional<Candidate> polished(const Problem& problem, int knots, const Improvement& improvement,
                                  base::Budget& budget, FreeSpace& space,
                                  const base::Deadline& deadline);

}  // namespace camway::correction
