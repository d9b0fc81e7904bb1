// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/correction/candidate.h"
#include "daemon/correction/constraints.h"

namespace camway::correction {

/// Replaces the path between the two keyframes about the collision by another way: a search finds a
/// free guide, first for a ball about the body on a lattice (`lattice_search.h`), then for the body
/// itself, turning included (`tree_search.h`); bumps draw the path towards it, with more and more
/// knots, until it is proved free; then it is improved under the objective (`relaxation.h`).
///
/// Nothing if no guide was found within the bounds of the searches, or none that the path could
/// follow.
std::optional<Candidate> go_round(const Problem& problem, Objective objective, FreeSpace& space,
                                  std::uint64_t seed, const collision::Deadline& deadline);

}  // namespace camway::correction
