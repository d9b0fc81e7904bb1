// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/improvement.h"
#include "daemon/correction/smoothing/path_sample.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// How near to its solution a minimum under contacts comes.
enum class Convergence : std::uint8_t {
  kUsual,   ///< by the sweeps that suffice for the objective
  kSettled  ///< until sweeps change little
};

/// The minimum of a smoothing form subject to the contacts of samples. The contacts keep the
/// multipliers, so that the next solution starts from the last one.
/// Not thread-safe.
class ConstrainedMinimum {
 public:
  /// Refers to `form`, which must outlive it. `improvement.worth` has no effect.
  ConstrainedMinimum(const SmoothingForm& form, const Improvement& improvement,
                     double ball_radius_m, double viewing_distance_m);

  /// The gap that suffices. [Units: metres]
  [[nodiscard]] double wanted_m() const { return bounds_.wanted_m(); }
  /// A gap that is next to nothing. [Units: metres]
  [[nodiscard]] double little_m() const { return bounds_.little_m(); }
  /// Sets the least gap that `kSafest` must keep. [Units: metres]
  void keep(double least_gap_m) { bounds_.keep(least_gap_m); }

  /// Returns the minimiser. Requires contacts with up to date rows. The first call sets the price
  /// of room, if the improvement makes room.
  StackedPoints find(const StackedPoints& variables, std::vector<PathSample>& samples,
                     Convergence convergence);

 private:
  /// Sets the price of room. At that price all gaps that are missing now are worth `kWorthOfRoom`
  /// of the form, beside what `ContactBounds` adds for small ones.
  void price_room(const StackedPoints& variables, const std::vector<PathSample>& samples);
  /// Finds the samples with contacts.
  void find_touching(std::vector<PathSample>& samples);

  const SmoothingForm& form_;
  ContactBounds bounds_;
  const double settled_m_;  ///< convergence threshold of the multipliers
  const int usual_sweeps_;  ///< of the solver
  const bool may_turn_;
  bool has_no_price_;                  ///< whether the price of room is still to be set
  std::vector<PathSample*> touching_;  ///< the samples with contacts, numbered in the bounds
  std::vector<Terms> terms_;           ///< of these samples
};

}  // namespace camway::correction
