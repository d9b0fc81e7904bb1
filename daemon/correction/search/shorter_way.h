// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/search/lattice_search.h"
#include "daemon/correction/search/lattice_ways.h"

namespace camway::correction {

/// Returns the search for a much shorter way of `ball` than `first`, on lattices with half the
/// spacing. They show windows and doors between the points of the coarse lattices. Returns nothing
/// if `first` is not long beside the distance of its ends, or took so many points that a finer
/// lattice would not get as far.
std::optional<BallMotion> shorter_way(const BallMotion& ball, const LatticeResult& first);

}  // namespace camway::correction
