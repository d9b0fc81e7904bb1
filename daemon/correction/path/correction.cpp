// SPDX-License-Identifier: MIT
#include "daemon/correction/path/correction.h"

namespace camway::correction {

std::string_view to_string(CorrectionKind kind) {
  switch (kind) {
    case CorrectionKind::kNone:
      return "none";
    case CorrectionKind::kMove:
      return "move";
    case CorrectionKind::kTurn:
      return "turn";
    case CorrectionKind::kGoRound:
      return "go_round";
    case CorrectionKind::kShrink:
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
