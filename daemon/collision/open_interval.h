// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/collision/probe.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// A stretch u0 <= u <= u1 of a segment. It is given by parameters of the whole segment, not by
/// control points of its own, so that rounding does not add up over subdivisions.
struct Piece {
  const motion::Segment* segment;
  double u0;
  double u1;

  [[nodiscard]] double middle() const { return 0.5 * (u0 + u1); }
  /// Returns whether the middle lies strictly between the ends, in doubles.
  [[nodiscard]] bool splittable() const { return middle() > u0 && middle() < u1; }
  [[nodiscard]] double begin_s() const { return motion::segment_time_s(*segment, u0); }
  [[nodiscard]] double end_s() const { return motion::segment_time_s(*segment, u1); }
};

/// A collision interval that is built from its first piece on while the path is searched. Joins
/// colliding pieces, and keeps the deepest of them for the witness.
/// Not thread-safe.
class OpenInterval {
 public:
  /// Returns whether the interval has a piece.
  [[nodiscard]] bool is_open() const { return last_.has_value(); }
  /// Returns the last piece. Requires `is_open`.
  [[nodiscard]] const Piece& last() const { return *last_; }
  /// Returns whether all of the last piece counts as colliding.
  [[nodiscard]] bool is_last_sure() const { return is_last_sure_; }
  [[nodiscard]] double begin_s() const { return begin_s_; }

  /// Appends a piece, or opens the interval with it. `gap_m`: the gap at the middle of the piece.
  /// `surely`: whether all of the piece counts as colliding.
  void extend(const Piece& piece, double gap_m, bool surely);

  /// Closes the interval. `witness` may still be called.
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
