// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/budget.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// A path that follows a guide.
struct Followed {
  std::optional<Candidate> candidate;  ///< nothing if the path cannot follow the guide
  int paths = 0;                       ///< changed paths that were checked for collisions
};

/// Replaces the path between the two keyframes of `problem` by one that follows `guide`. Rows of
/// bumps draw the path to the guide, with more and more knots, until it is proved free; where that
/// does not succeed with the guide as it is, the guide is shortened, and finer rows are added where
/// the path still collides. Then the number of knots is halved as long as the path stays free, and
/// the path is relaxed (`relaxation.h`), which spends steps of `budget`.
///
/// Requires a guide that begins and ends at the two keyframes, or an empty one, which no path
/// follows.
Followed follow(const Problem& problem, const Guide& guide, Turning turning, base::Budget& budget,
                FreeSpace& space, const base::Deadline& deadline);

}  // namespace camway::correction
