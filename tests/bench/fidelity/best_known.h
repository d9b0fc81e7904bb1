// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/range_search.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// Returns the answers from which the slow reference starts, beside the default one: without
/// turning, with little turning, with other viewing distances and seeds, and on other sides of what
/// collides: each side of a box about the keyframes is closed in turn. Only answers that are proved
/// free. Other objectives add none, as they start from the answer of the default objective.
std::vector<Answer> other_answers(const Shot& shot);

/// The slow reference: the cheapest path that is known for a shot. Each range of time in which some
/// start differs from the path as interpolated is searched by itself (`LocalSearch`). The cheapest
/// starts there have a trial, and the one that is then cheapest has the rest of the time.
///
/// Returns the path with its certificate and the processor time of the search; nothing if there are
/// no starts that keep `effort.clearance_m`. Requires that all starts have the reference of
/// `shot.interpolated()`. The result costs no more than any start that keeps that clearance.
std::optional<Answer> best_known(const Shot& shot, std::span<const motion::CubicPath> starts,
                                 const SearchEffort& effort);

}  // namespace camway::bench
