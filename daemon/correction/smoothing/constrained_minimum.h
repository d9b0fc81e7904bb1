// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/path_sample.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// The minimum of a smoothing form subject to the contacts of samples. Keeps the response of the
/// samples, and their contacts keep the multipliers, so that the next solution starts from the last
/// one.
/// Not thread-safe.
class ConstrainedMinimum {
 public:
  /// Refers to `form`, which must outlive it. Without `may_turn` orientations stay as they are.
  ConstrainedMinimum(const SmoothingForm& form, Objective objective, double ball_radius_m,
                     double viewing_distance_m, bool may_turn);

  /// The gap that suffices. [Units: metres]
  [[nodiscard]] double wanted_m() const { return bounds_.wanted_m(); }
  /// Forgets what it knows of the form, which was replaced.
  void forget_form();
  /// Sets the least gap that `kSafest` must keep. [Units: metres]
  void keep(double least_gap_m) { bounds_.keep(least_gap_m); }

  /// Returns the minimiser. Requires contacts with up to date rows, and at each call the samples of
  /// the one before, in their order, with any new ones after them.
  StackedPoints find(const StackedPoints& variables, std::vector<PathSample>& samples);

 private:
  void find_bounds(const StackedPoints& variables, std::vector<PathSample>& samples);
  const StackedPoints& unforced(const StackedPoints& minimum,
                                const std::vector<PathSample>& samples);
  const Eigen::MatrixXd& response(const std::vector<PathSample>& samples);

  const SmoothingForm& form_;
  ContactBounds bounds_;
  const double settled_m_;  ///< convergence threshold of the multipliers
  const bool may_turn_;
  StackedPoints unforced_{0, 7};  ///< the samples at the unconstrained minimum
  Eigen::MatrixXd response_;      ///< displacement of each sample per unit force on each
};

}  // namespace camway::correction
