// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/correction/path/constraints.h"
#include "daemon/correction/smoothing/contact_qp.h"
#include "daemon/correction/smoothing/contact_rows.h"

namespace camway::correction {

/// A contact with its last multipliers, from which the next solution starts.
struct Contact {
  ContactRow row;
  double hard_multiplier = 0.0;  ///< multiplier of the hard bound
  double soft_multiplier = 0.0;  ///< multiplier of the soft bound
};

/// The bounds that an objective derives from contacts, where a *gap* is the room of a contact and
/// wanted_m a gap that suffices:
///
///     objective                         hard bound             soft bound
///     any but kSafest, gap >= wanted_m  wanted_m               none
///     any but kSafest, gap < wanted_m   a share of the gap     wanted_m if room has a price
///     kSafest                           min(gap, least gap),   wanted_m, for the nearest vertex
///                                       for near vertices      of each triangle, without turning
class ContactBounds {
 public:
  ContactBounds(Objective objective, double ball_radius_m, double viewing_distance_m);

  /// Returns the gap that suffices. [Units: metres]
  [[nodiscard]] double wanted_m() const { return wanted_m_; }
  /// Returns a gap that is next to nothing, which costs more than others. [Units: metres]
  [[nodiscard]] double little_m() const;
  /// Sets the least gap that `kSafest` must keep: the least before the relaxation. [Units: metres]
  void keep(double least_gap_m) { least_gap_m_ = least_gap_m; }
  /// Sets what half a square metre of a missing gap costs, in units of the form that is minimised;
  /// a gap of next to nothing costs more. 0, the default, makes no room. `kSafest` has a price of
  /// its own. [Limit: 0 <= value]
  void set_price_of_room(double price) { price_of_room_ = price; }

  void clear();
  /// Adds the bounds of `contacts` on a sample whose displacement is `moved`. Requires contacts of
  /// one triangle to be adjacent, and `contacts` to stay in place until `remember`. `response`: the
  /// displacement of the sample per unit force on it.
  void add(std::size_t sample, const StackedPoint& moved, double response,
           std::span<Contact> contacts);
  [[nodiscard]] std::span<BoundConstraint> bounds() { return bounds_; }
  /// Stores the multipliers of `bounds()` in the contacts.
  void remember() const;

 private:
  void add_kept(std::size_t sample, const StackedPoint& moved, double response, Contact& contact);
  void add_hard(std::size_t sample, double bound_m, Contact& contact);
  void add_soft(std::size_t sample, const StackedPoint& direction, double bound_m,
                double compliance, double& multiplier);

  const bool is_safest_;
  const double wanted_m_;
  const double hard_reach_m_;
  double least_gap_m_ = 0.0;
  double price_of_room_ = 0.0;
  std::vector<BoundConstraint> bounds_;
  std::vector<double*> multipliers_;  ///< the multiplier in the contact of each bound
};

}  // namespace camway::correction
