// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// An inequality `direction · x >= bound_m` on the displacement x of a sample, and its multiplier.
struct ForcedBound {
  std::size_t sample = 0;
  StackedPoint direction = StackedPoint::Zero();
  double bound_m = 0.0;
  /// Compliance of the bound, relative to that of the path; 0 for a hard bound.
  double softness = 0.0;
  double force = 0.0;  ///< multiplier; in: an initial guess, out: the solution [Limit: value >= 0]
};

/// Finds the multipliers of a quadratic program: minimise a sum of squares subject to `bounds`.
/// Solves the dual by coordinate ascent (Hildreth 1957, "A quadratic programming procedure"). Stops
/// when no multiplier displaces a sample by more than `settled_m`, or after a fixed number of
/// sweeps; the result is then approximate, but never worse than the guess. Ignores bounds on
/// samples with zero compliance.
///
/// `unforced`: the samples at the unconstrained minimum, one per row. `reply`: the compliance
/// matrix, the displacement of each sample per unit force on another; symmetric and positive
/// semidefinite.
void find_forces(std::span<ForcedBound> bounds, const StackedPoints& unforced,
                 const Eigen::MatrixXd& reply, double settled_m);

}  // namespace camway::correction
