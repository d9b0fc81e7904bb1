// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/correction/path/guide.h"
#include "daemon/correction/search/tree_search.h"

namespace camway::correction {

/// Finds a guide from `from` to `to` along `way_W`, a way for a ball much smaller than the body:
/// straight motions through its narrow places (`narrow_passage.h`), joined by trees
/// (`tree_search.h`). `trees`: options of the trees; their polyline and number of samples are
/// chosen here. `TreeResult::samples` counts those of all trees. Deterministic for a seed, unless
/// the deadline strikes.
TreeResult threaded_guide(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                          const motion::SignedPose& from, const motion::SignedPose& to,
                          const TreeOptions& trees, const base::Deadline& deadline);

}  // namespace camway::correction
