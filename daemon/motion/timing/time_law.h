// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/timing/rate_limits.h"

namespace camway::motion {

/// A monotone map from the given times of a path to new ones. The *rate* dt/dτ, of the given time
/// by the new one, is in (0, 1]: it says how much slower the path becomes. Its square is a C¹
/// piecewise parabola of the given time, so the rate has a derivative without jumps, and the
/// acceleration of the path gets no new jumps. A value type. Thread-safe to read.
class TimeLaw {
 public:
  /// Returns the law that multiplies all durations by `factor`. Requires two knots or more,
  /// increasing, and `factor >= 1`.
  static TimeLaw uniform(std::vector<double> knots_s, double factor);

  /// Returns the law whose rate is as large as the limits allow, and nowhere above 1. So the path
  /// is slowed only where it would break a limit, and next to such places, to brake and to
  /// accelerate.
  ///
  /// By reachability analysis (Pham & Pham 2018, "A new approach to time-optimal path
  /// parameterization based on reachability analysis"). With x the squared rate, dx/dt = 2u, and
  /// the path P(t), which turns at the rate ω(t), the limits are
  ///     |P'|² x <= v²,  ω² x <= w²,  |P'' x + P' u| <= a,  x <= 1,
  /// which are convex in (u, x). A backward pass finds, at each stage, the largest x from which the
  /// end can be reached. A forward pass takes the largest x that it can. Deviations from the paper:
  /// - x is not piecewise linear between stages, where u would jump: the stages' x are the control
  ///   values of a quadratic B-spline, at their Greville abscissae. By de Boor's recursion each
  ///   (u, x) of the spline is a convex combination of those at the ends of the two stages that act
  ///   there; each stage meets the limits of all knots that it acts on; so the spline meets the
  ///   limits at every knot, without a margin. Between knots they hold in the limit of short steps.
  /// - The acceleration is limited by a circle, so a stage is no linear program. For a given x the
  ///   admissible u are an interval, in closed form; the x that have one are an interval too, whose
  ///   end is found by bisection.
  /// - x is kept above the largest constant that meets all limits. That constant is admissible at
  ///   each stage, so there is a solution for every path. Its duration is not longer than that of
  ///   multiplying all durations by one factor with which the same knots meet the limits.
  ///
  /// Knots are at the ends of segments, and at most `step_s` apart where the rate is below 1.
  /// O(knots). Requires `path` not to be empty, `step_s > 0` and limits above 0.
  static TimeLaw within(const Path& path, const RateLimits& limits, double step_s);

  /// Returns the law with its new times moved to times that are exact as sender's times, with
  /// `origin`. The given times `kept_s` stay; the shifts of their new times are spread over the
  /// knots between them. At those knots the given time shifts with the new one, so the path by the
  /// law is as smooth as before. Returns nothing if the sender's times are not fine enough for the
  /// knots. Requires that the times of `kept_s` within the law's span are knots and increase.
  [[nodiscard]] std::optional<TimeLaw> sendable(const TimeOrigin& origin,
                                                std::span<const double> kept_s) const;

  /// The new time for `given_s`; strictly increasing up to rounding, and at knots exactly
  /// `new_knots_s`. Clamped to the span of the law.
  [[nodiscard]] double new_time_s(double given_s) const;

  /// The rate dt/dτ at `given_s`: given seconds per new second. In (0, 1].
  [[nodiscard]] double rate(double given_s) const;

  /// Given times between which the squared rate is one parabola, and the new times there.
  [[nodiscard]] std::span<const double> knots_s() const& { return knots_s_; }
  [[nodiscard]] std::span<const double> new_knots_s() const& { return new_knots_s_; }
  std::span<const double> knots_s() const&& = delete;
  std::span<const double> new_knots_s() const&& = delete;

  /// New duration divided by given duration; at least 1.
  [[nodiscard]] double slow_down() const;

 private:
  TimeLaw(std::vector<double> knots_s, std::vector<std::array<double, 3>> squares);

  [[nodiscard]] std::size_t piece_at(double given_s) const;
  [[nodiscard]] double passed_s(std::size_t piece, double given_s) const;

  std::vector<double> knots_s_;
  std::vector<double> new_knots_s_;
  std::vector<std::array<double, 3>> squares_;  ///< Bézier points of the squared rate of each piece
};

}  // namespace camway::motion
