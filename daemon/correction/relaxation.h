// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/candidate.h"
#include "daemon/correction/constraints.h"
#include "daemon/correction/guide.h"

namespace camway::correction {

/// A correction that is proved free: `problem.path` with `bumps_for(offsets, ends)`.
struct Relaxed {
  Offsets offsets;
  Candidate candidate;
};

/// Improves a free correction under an objective, and keeps it free: coefficient by coefficient is
/// moved to where its neighbours and the objective would have it, or as far towards that as the
/// body stays free at sampled times; the result is proved, and where it is not free it is taken
/// back step by step, to what it began with in the end. Bounded by a number of passes.
///
/// The objectives are quadratic forms of the control points (Farin 2002, section 9.4, for bending):
/// distances from the original and second differences for `kClosest`, first differences for
/// `kShortest`, second for `kSmoothest`. For `kSafest` the gaps themselves decide, and second
/// differences between what is equally far.
Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, Objective objective,
                FreeSpace& space, const collision::Deadline& deadline);

/// Improves what lies between the two keyframes of the gap, and a little beyond, of a path that is
/// free already. Nothing where nothing better was found.
std::optional<Candidate> polished(const Problem& problem, Objective objective, FreeSpace& space,
                                  const collision::Deadline& deadline);

}  // namespace camway::correction
