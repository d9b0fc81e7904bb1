// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "daemon/base/budget.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/path/pocket.h"

namespace camway::correction {

/// The kind of search for a detour.
enum class Search : std::uint8_t {
  kQuick,     ///< ways on coarse lattices alone, for which no proof is asked
  kWithRoom,  ///< ways with room for the body in any orientation; cheap
  kNarrow,    ///< ways that are narrower than the ball that holds the body in any orientation
};

/// Proofs that there is no detour, which are looked for when a search becomes costly.
struct ProofsOfNoWay {
  std::function<bool()> is_separated;  ///< costs less than a lattice
  std::function<bool()> is_caged;      ///< costs about as much as a fine lattice
};

struct DetourResult {
  std::optional<Candidate> candidate;  ///< nothing if no detour was found
  Effort effort;                       ///< effort spent
  /// The region about one end of the interval out of which no search found a way, if there is one.
  std::optional<Pocket> pocket;
};

/// Replaces the path between the two keyframes about the collision by a detour. A search finds a
/// free guide: for a ball about the body on a lattice (`lattice_search.h`), or for the body itself
/// along the way of a smaller ball (`narrow_passage.h`, `tree_search.h`). Bumps draw the path to
/// the guide, with more and more knots, until it is proved free; then it is relaxed towards the
/// path as interpolated (`relaxation.h`), which spends steps of `budget`.
///
/// Finds no detour if the search found no guide within its limits, or the path could not follow
/// one. Asks for proofs before a search with room becomes costly, and gives up if there is one.
DetourResult go_round(const Problem& problem, Search search, base::Budget& budget, FreeSpace& space,
                      std::uint64_t seed, const ProofsOfNoWay& proofs,
                      const base::Deadline& deadline);

}  // namespace camway::correction
