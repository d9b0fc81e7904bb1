// SPDX-License-Identifier: MIT
#include "daemon/collision/open_interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/witness.h"
#include "daemon/motion/path/stretch.h"

namespace camway::collision {

void OpenInterval::extend(const Piece& piece, double gap_m, bool surely) {
  if (!is_open()) {
    begin_s_ = piece.begin_s();
    closest_gap_m_ = std::numeric_limits<double>::infinity();
    contacts_.clear();
  }
  last_ = piece;
  is_last_sure_ = surely;
  if (gap_m <= 0.0 || gap_m < closest_gap_m_) {
    if (closest_gap_m_ > 0.0) contacts_.clear();
    closest_gap_m_ = std::min(closest_gap_m_, gap_m);
    contacts_.push_back(piece);
  }
}

std::optional<Witness> OpenInterval::witness(Probe& probe, double time_s) const {
  const auto distance_s = [&](const Piece& piece) {
    return std::abs(motion::segment_time_s(*piece.segment, piece.middle()) - time_s);
  };
  const auto contact = std::ranges::min_element(contacts_, {}, distance_s);
  if (contact == contacts_.end()) return std::nullopt;
  const double u = contact->middle();
  std::optional<Witness> found = deepest_contact(
      probe, motion::SegmentMotion(*contact->segment).around(u, u), std::max(closest_gap_m_, 0.0));
  if (found) found->time_s = motion::segment_time_s(*contact->segment, u);
  return found;
}

}  // namespace camway::collision
