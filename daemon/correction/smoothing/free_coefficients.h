// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/stacked_point.h"
#include "daemon/correction/smoothing/sum_of_squares.h"

namespace camway::correction {

/// Knots from a bump's peak to the end of its support.
inline constexpr int kBumpReach = 2;

/// Returns whether a row of bumps on `knots` can have free ends. The bumps that keep the two
/// keyframes of the interval reach two knots beyond these keyframes; they must not reach the next
/// keyframes.
bool fits_free_ends(const Problem& problem, const motion::KnotRow& knots);

/// The coefficients of a row of bumps that a correction may choose. With fixed ends they are those
/// of the bumps whose supports lie within the row. With free ends they also include bumps before
/// the first and after the last keyframe of the interval, as far as these do not reach the next
/// keyframe. So the path may change its slope at the two keyframes. The coefficient at a keyframe
/// is *held*: it follows from its two neighbours so that the keyframe is kept. Requires every
/// keyframe within the supports to be at a knot, with no keyframe at the next knot; with free ends
/// that holds for other keyframes than the two where free ends fit (`fits_free_ends`).
class FreeCoefficients {
 public:
  FreeCoefficients(const Problem& problem, const motion::KnotRow& knots, Ends ends);

  [[nodiscard]] const motion::KnotRow& knots() const { return knots_; }
  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int last() const { return last_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] bool is_held(int k) const {
    return std::ranges::find(held_, k, &Held::knot) != held_.end();
  }

  /// Adds `factor` times the coefficient at knot `k` to `terms`, and nothing if `k` is outside of
  /// [first(), last()].
  void add(int k, double factor, Terms& terms) const;
  /// Returns the value of the row of bumps at a time; no terms outside of the supports.
  [[nodiscard]] Terms at(double time_s) const;
  /// Returns the bump at knot `k`. [Limit: first() <= k <= last()]
  [[nodiscard]] const motion::KnotBump& bump(int k) const {
    return bumps_[static_cast<std::size_t>(k - first_)];
  }

  [[nodiscard]] StackedPoints variables_of(const Offsets& offsets, double lever_m) const;
  [[nodiscard]] Offsets offsets_of(const StackedPoints& variables, double lever_m) const;

 private:
  static constexpr Eigen::Index kNoVariable = -1;

  /// The variable of the coefficient at knot `k`; kNoVariable if that is held.
  [[nodiscard]] Eigen::Index variable(int k) const {
    return variables_[static_cast<std::size_t>(k - first_)];
  }

  /// The knot of a keyframe. Its coefficient is `of_before` times the one before, plus `of_after`
  /// times the one after.
  struct Held {
    int knot;
    double of_before;
    double of_after;
  };
  void hold(int knot);

  motion::KnotRow knots_;
  std::vector<motion::KnotBump> bumps_;  ///< from `first_` to `last_`
  std::vector<Eigen::Index> variables_;  ///< of these knots, by `variable`
  int first_ = 0;
  int last_ = 0;
  Eigen::Index size_ = 0;
  std::vector<Held> held_;
};

}  // namespace camway::correction
