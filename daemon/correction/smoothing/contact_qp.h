// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "daemon/correction/smoothing/stacked_point.h"
#include "daemon/correction/smoothing/sum_of_squares.h"

namespace camway::correction {

/// An inequality `direction · x >= bound_m` on the place x of a sample, and its multiplier.
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

/// How variables give way to forces on samples: a force on sample i displaces each variable by its
/// element of column i, times the force.
using Responses = Eigen::MatrixXd;

/// Returns the responses to forces on `samples`, where `factors` are of the Hessian of the form
/// that the variables minimise.
Responses responses_of(std::span<const Terms> samples, const BandFactors& factors);

/// Returns the displacement of a sample per unit force on it: that of its terms by `response`, the
/// column of the sample.
double own_response(const Terms& sample, const Eigen::Ref<const Eigen::VectorXd>& response);

/// Finds the minimum of a quadratic form subject to `bounds` on samples of it, and the multipliers
/// there. Solves the dual by coordinate ascent (Hildreth 1957, "A quadratic programming
/// procedure"). Stops when no multiplier displaces a sample by more than `settled_m`, or after
/// `most_sweeps` sweeps; the result is then approximate, but never worse than the guess. Ignores
/// bounds on samples with zero response. Requires the bounds of one sample to be adjacent.
///
/// `variables`: in: the unconstrained minimum; out: the minimum.
void solve_qp(std::span<BoundConstraint> bounds, std::span<const Terms> samples,
              const Responses& responses, double settled_m, int most_sweeps,
              StackedPoints& variables);

}  // namespace camway::correction
