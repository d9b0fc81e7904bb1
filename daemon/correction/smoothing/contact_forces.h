// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// A lower bound of how far a sample of the path goes in a direction, and the force that makes it
/// keep to that.
struct ForcedBound {
  std::size_t sample = 0;
  StackedPoint direction = StackedPoint::Zero();
  double bound_m = 0.0;  ///< of direction · sample
  /// How far the bound gives way to a unit force, as a share of how far the path does; 0 for one
  /// that has to hold.
  double softness = 0.0;
  double force = 0.0;  ///< in: a guess, [Limit: value >= 0]
};

/// Forces under which a sum of squares is least while the bounds hold: the dual of a quadratic
/// program, force by force (Hildreth 1957, "A quadratic programming procedure"). Stops where no
/// force moves a sample by more than `settled_m`, or after a number of sweeps: approximate then,
/// but never worse than the guess. Bounds that no force can help, as their sample does not reply to
/// one, are left alone.
///
/// `unforced`: where the samples are at the minimum without forces, a row each; `reply`: how far
/// each sample moves by a unit force on another, symmetric and positive semidefinite.
void find_forces(std::span<ForcedBound> bounds, const StackedPoints& unforced,
                 const Eigen::MatrixXd& reply, double settled_m);

}  // namespace camway::correction
