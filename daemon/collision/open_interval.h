// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/collision/probe.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// A stretch u0 <= u <= u1 of a segment, as parameters of the whole segment and not as control
/// points of its own, so that rounding does not add up over subdivisions.
struct Piece {
  const motion::Segment* segment;
  double u0;
  double u1;

  [[nodiscard]] double middle() const { return 0.5 * (u0 + u1); }
  /// False for a piece so short that its middle is one of its ends.
  [[nodiscard]] bool splittable() const { return middle() > u0 && middle() < u1; }
  [[nodiscard]] double begin_s() const { return motion::segment_time_s(*segment, u0); }
  [[nodiscard]] double end_s() const { return motion::segment_time_s(*segment, u1); }
};

/// A collision interval whose end is not known yet, while the path is walked: its colliding pieces
/// joined, and the deepest of them, for its witness. Not thread-safe.
class OpenInterval {
 public:
  /// Returns whether the interval has a piece.
  [[nodiscard]] bool is_open() const { return last_.has_value(); }
  /// Returns its last piece. Requires that it is open.
  [[nodiscard]] const Piece& last() const { return *last_; }
  /// Returns whether all of the last piece counts as colliding.
  [[nodiscard]] bool is_last_sure() const { return is_last_sure_; }
  [[nodiscard]] double begin_s() const { return begin_s_; }

  /// Appends a piece with that gap at its middle; opens the interval if it is not open.
  void extend(const Piece& piece, double gap_m, bool surely);

  /// Forgets all pieces but those that `witness` needs.
  void close() { last_.reset(); }

  /// Returns the deepest contact of the deepest piece whose middle is nearest to `time_s`; nothing
  /// if there is no obstacle near.
  [[nodiscard]] std::optional<Witness> witness(Probe& probe, double time_s) const;

 private:
  std::optional<Piece> last_;
  bool is_last_sure_ = false;
  double begin_s_ = 0.0;
  double closest_gap_m_ = 0.0;
  std::vector<Piece> contacts_;  ///< pieces with the closest gap, or with none
};

}  // namespace camway::collision
