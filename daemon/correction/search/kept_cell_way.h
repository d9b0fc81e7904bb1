// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

struct KeptWay {
  Guide guide;            ///< from begin to end, both included; empty if none was found
  std::size_t cells = 0;  ///< number of cells looked at
};

/// Searches a way on which the body moves without turning, by the cells of `cell_search.h`: they
/// are free where the body itself is, and not a ball in it. So the way does not lead under a table
/// or over a bed that a small ball passes and the body does not. `from` and `to` have about the
/// same orientation; the body has the one of `from` between them. The motions are free as computed,
/// and not proved. Deterministic, unless the deadline strikes.
KeptWay kept_cell_way(FreeSpace& space, const motion::SignedPose& from,
                      const motion::SignedPose& to, std::size_t max_cells,
                      const base::Deadline& deadline);

}  // namespace camway::correction
