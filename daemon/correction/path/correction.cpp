// SPDX-License-Identifier: MIT
#include "daemon/correction/path/correction.h"

namespace camway::correction {

Effort& Effort::operator+=(const Effort& other) {
  directions += other.directions;
  paths += other.paths;
  lattice_points += other.lattice_points;
  tree_samples += other.tree_samples;
  return *this;
}

}  // namespace camway::correction
