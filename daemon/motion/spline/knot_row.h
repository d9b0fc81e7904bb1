// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/motion/path/time_origin.h"

namespace camway::motion {

/// Shortest duration of a piece, in an interval between keyframes of duration `interval_s`, for
/// which doubles still carry the acceleration. `travelled_m` is the distance that the path travels
/// in the interval, `size_m` the largest coordinate there.
///
/// With eps = 2^-52, a control point is off by at most ρ = 4·eps·size_m: it is cut out of a cubic
/// by three convex combinations, each off by eps, and has bumps added. A second difference of
/// control points is off by 4·ρ, and the acceleration of a piece of duration h by 6·4·ρ/h².
/// Accelerations of a path that goes `travelled_m` in `interval_s` are of the size
/// travelled_m/interval_s². The result is the h for which rounding makes `kAccelerationNoise` of
/// that, but at most `interval_s`.
double least_piece_s(double interval_s, double travelled_m, double size_m);
inline constexpr double kAccelerationNoise = 1e-3;

/// Times at which knots of rows of bumps may be. Thread-safe to read.
struct KnotPlaces {
  TimeOrigin origin;            ///< knots are at times that are exact as sender's times
  std::vector<double> taken_s;  ///< times of existing knots, increasing
  double same_s = 0.0;          ///< a new knot nearer than this to an existing one moves onto it

  /// Returns the time to use for a knot that is wanted at `time_s`, in a row with the spacing
  /// `spacing_s`. A knot moves to an existing one by at most an eighth of the spacing, so knots
  /// stay in order.
  [[nodiscard]] double place_s(double time_s, double spacing_s) const;
};

/// A cubic B-spline on five increasing knots.
struct KnotBump {
  explicit KnotBump(const std::array<double, 5>& knots);

  /// Returns the value at a time; 0 outside of the knots.
  [[nodiscard]] double value(double time_s) const;
  /// Returns the first derivative at a time; 0 outside of the knots.
  [[nodiscard]] double first_derivative(double time_s) const;
  /// Returns the second derivative at a time; 0 outside of the knots.
  [[nodiscard]] double second_derivative(double time_s) const;

  std::array<double, 5> knots_s;
  std::array<std::array<double, 4>, 4> pieces;  ///< `b_spline_pieces` of the knots

 private:
  /// Returns the piece that holds a time, and the parameter there; nothing outside of the knots.
  [[nodiscard]] std::optional<std::pair<std::size_t, double>> place_of(double time_s) const;
};

/// Knots in `count` steps from `begin_s` to `end_s`, continued beyond both. They are at given
/// times, or equidistant and then moved to times that `places` allows.
struct KnotRow {
  double begin_s = 0.0;
  double end_s = 1.0;  ///< [Limit: value > begin_s]
  int count = 1;       ///< [Limit: value >= 1]
  /// Times allowed for knots; null allows any.
  std::shared_ptr<const KnotPlaces> places;
  /// The times of knots 0 to `count`; null for equidistant knots.
  std::shared_ptr<const std::vector<double>> given_s;

  KnotRow() = default;
  KnotRow(double begin, double end, int steps, std::shared_ptr<const KnotPlaces> where = nullptr)
      : begin_s(begin), end_s(end), count(steps), places(std::move(where)) {}

  /// A row with knots at `times_s`, moved to the nearest times allowed by `places`. Requires at
  /// least two times, increasing.
  static KnotRow at(const std::vector<double>& times_s, std::shared_ptr<const KnotPlaces> places);

  /// A row of four steps of `spacing_s` whose middle knot is at `middle_s` or next to it.
  static KnotRow about(double middle_s, double spacing_s, std::shared_ptr<const KnotPlaces> places);

  /// Time of knot `index`; exactly `begin_s` at 0 and `end_s` at `count`. The index may be
  /// negative. Increases with the index if the row fits.
  [[nodiscard]] double knot_s(int index) const;
  /// The mean step between `begin_s` and `end_s`.
  [[nodiscard]] double spacing_s() const { return (end_s - begin_s) / count; }
  /// Whether the sender's times are fine enough for the row: at least `kLeastTimesAStep` of them in
  /// a step.
  [[nodiscard]] bool fits() const;

  /// The cubic B-spline on the knots `index - 2` to `index + 2`. The sum of all of them is 1.
  [[nodiscard]] KnotBump bump(int index) const;
  /// Returns the value of `bump(bump)` at a knot.
  [[nodiscard]] double bump_at_knot(int bump, int knot) const;
};

/// Least number of sender's times in a step between knots (`KnotRow::fits`).
inline constexpr double kLeastTimesAStep = 16.0;
/// Number of sender's times from one knot to the next that a request can hold both as keyframes
/// (`planning::kLeastRelativeTimeStep`).
inline constexpr double kTimesBetweenKeyframes = 128.0;

/// The four pieces of the cubic B-spline on five increasing knots, as Bézier points (Farin 2002,
/// section 8.6). Adjacent pieces have the same value where they meet, bit for bit.
std::array<std::array<double, 4>, 4> b_spline_pieces(const std::array<double, 5>& knots);

}  // namespace camway::motion
