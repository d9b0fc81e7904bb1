// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

/// Replaces the path between the two keyframes of `problem` by one that follows `guide`. Rows of
/// bumps draw the path to the guide, with more and more knots, until it is proved free; where that
/// does not succeed with the guide as it is, the guide is shortened, and finer rows are added where
/// the path still collides. Then the number of knots is halved as long as the path stays free, and
/// the path is relaxed under the objective of `improvement`, whose steps that spends.
///
/// Returns nothing if the path cannot follow the guide, or the guide is empty. Requires a guide
/// that begins and ends at the two keyframes.
std::optional<Candidate> follow(const Problem& problem, const Guide& guide, Turning turning,
                                Improvement& improvement, FreeSpace& space,
                                const base::Deadline& deadline);

}  // namespace camway::correction
