// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/candidate.h"
#include "daemon/correction/constraints.h"
#include "daemon/correction/guide.h"

namespace camway::correction {

/// Improves a free correction under an objective, and keeps it free: coefficient by coefficient is
/// moved to where its neighbours and the objective would have it, or as far towards it as the body
/// stays free at sampled times; the result is proved, and if it is not free it is taken back step
/// by step. `free` is `problem.path` with `bumps_for(offsets, ends)`. Never worse than that in what
/// it proves; bounded by `sweeps` passes over all coefficients.
///
/// The objectives are quadratic forms of the control points (Farin 2002, section 9.4, for bending):
/// the offsets and their second differences for `kClosest`, first differences of the path for
/// `kShortest`, second for `kSmoothest`. For `kSafest` the gaps themselves decide, and second
/// differences between what is equal.
struct Relaxed {
  Offsets offsets;
  Candidate candidate;
};
Relaxed relaxed(const Problem& problem, const Offsets& offsets, Ends ends, Candidate free,
                Objective objective, int sweeps, FreeSpace& space,
                const collision::Deadline& deadline);

}  // namespace camway::correction
