// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/correction/path/constraints.h"
#include "daemon/correction/smoothing/contact_forces.h"
#include "daemon/correction/smoothing/contacts.h"

namespace camway::correction {

/// A contact, and the forces that last kept the path from it: hard where it has to keep away, soft
/// where it would better.
struct Contact {
  ContactRow row;
  double hard_force = 0.0;
  double soft_force = 0.0;
};

/// What an objective asks of contacts. All but `kSafest` want a small gap: hard where it is there,
/// else not much less than there is, and softly what is wanted. `kSafest` wants a wide one, softly,
/// of the vertex that is nearest to each triangle, and hard no less than the least there was.
class ContactBounds {
 public:
  ContactBounds(Objective objective, double ball_radius_m);

  /// Gap that is wanted. [Units: metres]
  [[nodiscard]] double wanted_m() const { return wanted_m_; }
  /// The least gap there was, for `kSafest`. [Units: metres]
  void keep(double least_gap_m) { least_gap_m_ = least_gap_m; }

  void clear();
  /// What `contacts` ask of a sample that `moved` so far; those of a triangle follow each other,
  /// and must stay where they are until `remember`. `reply`: how far the sample moves by a unit
  /// force.
  void add(std::size_t sample, const StackedPoint& moved, double reply,
           std::span<Contact> contacts);
  [[nodiscard]] std::span<ForcedBound> bounds() { return bounds_; }
  /// Puts the forces back into the contacts.
  void remember() const;

 private:
  void add_kept(std::size_t sample, const StackedPoint& moved, Contact& contact);
  void add_hard(std::size_t sample, double bound_m, Contact& contact);
  void add_soft(std::size_t sample, const StackedPoint& direction, double bound_m, double softness,
                double& force);

  const bool is_safest_;
  const double wanted_m_;
  const double hard_reach_m_;
  double least_gap_m_ = 0.0;
  std::vector<ForcedBound> bounds_;
  std::vector<double*> forces_;  ///< of each, in its contact
};

}  // namespace camway::correction
