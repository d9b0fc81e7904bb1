// SPDX-License-Identifier: MIT
#pragma once

namespace camway::motion {

/// The instant from which planning counts time. Doubles near 1.76e9 s (seconds since 1970) are
/// 2.4e-7 s apart. Planning counts from the first keyframe, where they are finer, and divides a
/// path only at times whose sum with the origin is exact (`nearest_s`). So each segment has the
/// same duration for sender and planning, bit for bit, and a receiver computes the planned
/// derivatives. A value type.
struct TimeOrigin {
  double s = 0.0;  ///< the sender's time at planning's time 0 [Units: seconds]

  /// Returns the origin for a path from `first_s` to `last_s`: `first_s` if the path is shorter
  /// than the distance of either from 0, otherwise 0, as nothing would be gained. In both cases
  /// `sent_s(local_s(t)) == t` for each t between the two: in the first case t is within a factor
  /// of 2 of the origin, so their difference is exact (Sterbenz 1974).
  static TimeOrigin of(double first_s, double last_s);

  /// Planning's time for the sender's time `sent_s`.
  [[nodiscard]] double local_s(double sent_s) const { return sent_s - s; }
  /// The sender's time for planning's time `local_s`, rounded to a double.
  [[nodiscard]] double sent_s(double local_s) const { return s + local_s; }
  /// The sender's time, rounded down, or up, to a double.
  [[nodiscard]] double sent_not_after_s(double local_s) const;
  [[nodiscard]] double sent_not_before_s(double local_s) const;

  /// The time nearest to `local_s` that is exact as a sender's time.
  [[nodiscard]] double nearest_s(double local_s) const { return (s + local_s) - s; }
  /// Distance of such times about `local_s`.
  [[nodiscard]] double resolution_s(double local_s) const;
};

}  // namespace camway::motion
