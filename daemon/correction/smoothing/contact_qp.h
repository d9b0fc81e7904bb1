// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// An inequality `direction · x >= bound_m` on the displacement x of a sample, and its multiplier.
struct BoundConstraint {
  std::size_t sample = 0;
  StackedPoint direction = StackedPoint::Zero();
  double bound_m = 0.0;
  /// Compliance of the bound, relative to that of the path; 0 for a hard bound.
  double compliance = 0.0;
  /// In: an initial guess; out: the solution. [Limit: value >= 0]
  double multiplier = 0.0;
};

/// Sweeps that suffice where the next step corrects what is still missing. Chosen by measurement.
inline constexpr int kFewSweeps = 10;

/// Finds the multipliers of a quadratic program: minimise a sum of squares subject to `bounds`.
/// Solves the dual by coordinate ascent (Hildreth 1957, "A quadratic programming procedure"). Stops
/// when no multiplier displaces a sample by more than `settled_m`, or after `most_sweeps` sweeps;
/// the result is then approximate, but never worse than the guess. Ignores bounds on
/// samples with zero response.
///
/// `unforced`: the samples at the unconstrained minimum, one per row. `response`: the
/// displacement of each sample per unit force on another; symmetric and positive semidefinite.
void solve_qp(std::span<BoundConstraint> bounds, const StackedPoints& unforced,
              const Eigen::MatrixXd& response, double settled_m, int most_sweeps = kFewSweeps);

}  // namespace camway::correction
