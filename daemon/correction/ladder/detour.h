// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

/// How a way round is looked for.
enum class Search : std::uint8_t {
  kWithRoom,  ///< where the body may be turned as it likes; cheap
  kTurning,   ///< where it has to be turned to get through
};

/// Replaces the path between the two keyframes about the collision by another way: a search finds a
/// free guide, for a ball about the body on a lattice (`lattice_search.h`) or for the body itself
/// along the ways of smaller balls (`tree_search.h`); bumps draw the path towards it, with more and
/// more knots, until it is proved free; then it is improved under the objective (`relaxation.h`).
///
/// Nothing if no guide was found within the bounds of the search, or none that the path could
/// follow. `is_hopeless` is asked before the search with room becomes costly; if it is, that is
/// all.
std::optional<Candidate> go_round(const Problem& problem, Search search, Improvement& improvement,
                                  FreeSpace& space, std::uint64_t seed,
                                  const std::function<bool()>& is_hopeless,
                                  const collision::Deadline& deadline);

}  // namespace camway::correction
