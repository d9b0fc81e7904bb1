// SPDX-License-Identifier: MIT
#include "daemon/correction/path/correction.h"

#include <algorithm>
#include <limits>

namespace camway::correction {

Effort& Effort::operator+=(const Effort& other) {
  const auto add = [](std::int32_t& count, std::int32_t more) {
    count += std::min(more, std::numeric_limits<std::int32_t>::max() - count);
  };
  add(directions, other.directions);
  add(paths, other.paths);
  add(lattice_points, other.lattice_points);
  add(tree_samples, other.tree_samples);
  return *this;
}

}  // namespace camway::correction
