// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "daemon/motion/path/time_origin.h"

namespace camway::motion {

/// Shortest duration of a piece, in a gap between keyframes that takes `gap_s`, whose acceleration
/// doubles still carry. `travelled_m` is how far the path goes in the gap, `size_m` the largest
/// coordinate there.
///
/// With eps = 2^-52, a control point is off by at most ρ = 4·eps·size_m: it is cut out of a cubic
/// by three convex combinations, each off by eps, and has bumps added. A second difference of
/// control points is off by 4·ρ, and the acceleration of a piece of duration h by 6·4·ρ/h².
/// Accelerations of a path that goes `travelled_m` in `gap_s` are of the size travelled_m/gap_s².
/// The bound is the h for which rounding makes `kAccelerationNoise` of that. Not more than `gap_s`.
double least_piece_s(double gap_s, double travelled_m, double size_m);
inline constexpr double kAccelerationNoise = 1e-3;

/// Where the knots of rows of bumps may be. Thread-safe to read.
struct KnotPlaces {
  TimeOrigin origin;            ///< knots are at times that the sender can be told exactly
  std::vector<double> taken_s;  ///< times of knots that are there already, increasing
  double same_s = 0.0;          ///< a knot nearer to one of these takes its place

  /// The place of a knot that is wanted at `time_s`, in a row with that spacing. It moves by an
  /// eighth of the spacing at the most, so knots stay in order.
  [[nodiscard]] double place_s(double time_s, double spacing_s) const;
};

/// Knots in `count` steps from `begin_s` to `end_s`, and as many more beyond as are asked for:
/// equidistant, but for the places that they may be at.
struct KnotRow {
  double begin_s = 0.0;
  double end_s = 1.0;  ///< [Limit: value > begin_s]
  int count = 1;       ///< [Limit: value >= 1]
  /// Null: knots may be anywhere.
  std::shared_ptr<const KnotPlaces> places;

  KnotRow() = default;
  KnotRow(double begin, double end, int steps, std::shared_ptr<const KnotPlaces> where = nullptr)
      : begin_s(begin), end_s(end), count(steps), places(std::move(where)) {}

  /// Four steps of `spacing_s`, of which the knot in the middle is at `middle_s` or next to it.
  static KnotRow about(double middle_s, double spacing_s, std::shared_ptr<const KnotPlaces> places);

  /// Knot `index`; exactly `begin_s` at 0 and `end_s` at `count`. Increases with the index, which
  /// may be negative, if the row fits.
  [[nodiscard]] double knot_s(int index) const;
  /// The mean step between `begin_s` and `end_s`.
  [[nodiscard]] double spacing_s() const { return (end_s - begin_s) / count; }
  /// Whether times are fine enough for the row: `kLeastTimesAStep` of them to a step.
  [[nodiscard]] bool fits() const;

  /// The cubic B-spline on knots `bump - 2` to `bump + 2`, of the basis whose sum is 1, at a time.
  [[nodiscard]] double bump_value(int bump, double time_s) const;
  /// Its value at a knot.
  [[nodiscard]] double bump_at_knot(int bump, int knot) const;
};

inline constexpr double kLeastTimesAStep = 16.0;

/// The four pieces of the cubic B-spline on five knots, which increase, as Bézier points (Farin
/// 2002, section 8.6). Where two pieces meet they have the same value, bit for bit.
std::array<std::array<double, 4>, 4> b_spline_pieces(const std::array<double, 5>& knots);

}  // namespace camway::motion
