// SPDX-License-Identifier: MIT
#include "daemon/correction/path/correction.h"

namespace camway::correction {

std::string_view to_string(Rung rung) {
  switch (rung) {
    case Rung::kNone:
      return "none";
    case Rung::kMove:
      return "move";
    case Rung::kTurn:
      return "turn";
    case Rung::kGoRound:
      return "go_round";
    case Rung::kShrink:
      return "shrink";
  }
  return "none";
}

Effort& Effort::operator+=(const Effort& other) {
  directions += other.directions;
  paths += other.paths;
  lattice_points += other.lattice_points;
  tree_samples += other.tree_samples;
  return *this;
}

}  // namespace camway::correction
