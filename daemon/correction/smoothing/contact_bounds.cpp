// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_bounds.h"

#include <algorithm>

#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kWanted = 0.7;          // gap that is kept where there is room for it, ...
constexpr double kWantedShift = 0.02;    // ... or this share of the viewing distance, if less
constexpr double kWantedOfCurve = 0.03;  // gap that suffices for a measure of the curve alone
constexpr double kKeptShare = 0.9;       // share of a smaller gap that is kept
constexpr double kLittle = 0.15;         // share of the wanted gap: the first part of a gap, ...
constexpr double kMoreWorth = 6.0;       // ... which is worth so much more
constexpr double kHardReach = 0.5;       // `kSafest` has hard bounds only for nearer vertices
constexpr double kUrge = 4.0;  // weight of a squared missing gap, relative to a squared distance

double wanted_gap_m(Objective objective, double ball_radius_m, double viewing_distance_m) {
  if (objective == Objective::kSafest) return kComfort * ball_radius_m;
  const double share = measures_curve(objective) ? kWantedOfCurve : kWanted;
  return std::min(share * ball_radius_m, kWantedShift * viewing_distance_m);
}

}  // namespace

ContactBounds::ContactBounds(Objective objective, double ball_radius_m, double viewing_distance_m)
    : is_safest_(objective == Objective::kSafest),
      wanted_m_(wanted_gap_m(objective, ball_radius_m, viewing_distance_m)),
      hard_reach_m_(kHardReach * ball_radius_m) {}

double ContactBounds::little_m() const { return kLittle * wanted_m_; }

void ContactBounds::clear() {
  bounds_.clear();
  multipliers_.clear();
}

void ContactBounds::add(std::size_t sample, const StackedPoint& moved, double response,
                        std::span<Contact> contacts) {
  if (!is_safest_) {
    for (Contact& contact : contacts) add_kept(sample, moved, response, contact);
    return;
  }
  for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
    std::size_t nearest = begin;
    for (; end < contacts.size() && contacts[end].row.triangle == contacts[begin].row.triangle;
         ++end) {
      Contact& contact = contacts[end];
      if (contact.row.room_m < contacts[nearest].row.room_m) nearest = end;
      if (contact.row.room_m > hard_reach_m_) continue;
      const double kept_m = std::min(contact.row.room_m, least_gap_m_);
      add_hard(sample, contact.row.direction.dot(moved) - contact.row.room_m + kept_m, contact);
    }
    Contact& contact = contacts[nearest];
    // Room is made by moving: turning away from what is near finds no end.
    StackedPoint away = contact.row.direction;
    away.tail<4>().setZero();
    const double stiffness = response * away.squaredNorm();
    if (!(stiffness > 0.0)) continue;
    add_soft(sample, away, away.dot(moved) - contact.row.room_m + wanted_m_,
             1.0 / (kUrge * stiffness), contact.soft_multiplier);
  }
}

void ContactBounds::add_kept(std::size_t sample, const StackedPoint& moved, double response,
                             Contact& contact) {
  const ContactRow& row = contact.row;
  const double offset_m = row.direction.dot(moved) - row.room_m;
  const bool has_room = row.room_m >= wanted_m_;
  add_hard(sample, offset_m + (has_room ? wanted_m_ : kKeptShare * row.room_m), contact);
  const double urgency = 1.0 + kMoreWorth * std::max(0.0, 1.0 - row.room_m / little_m());
  const double stiffness = urgency * price_of_room_ * response * row.direction.squaredNorm();
  if (has_room || !(stiffness > 0.0)) {
    contact.soft_multiplier = 0.0;
  } else {
    add_soft(sample, row.direction, offset_m + wanted_m_, 1.0 / stiffness, contact.soft_multiplier);
  }
}

void ContactBounds::add_hard(std::size_t sample, double bound_m, Contact& contact) {
  bounds_.push_back({sample, contact.row.direction, bound_m, 0.0, contact.hard_multiplier});
  multipliers_.push_back(&contact.hard_multiplier);
}

void ContactBounds::add_soft(std::size_t sample, const StackedPoint& direction, double bound_m,
                             double compliance, double& multiplier) {
  bounds_.push_back({sample, direction, bound_m, compliance, multiplier});
  multipliers_.push_back(&multiplier);
}

void ContactBounds::remember() const {
  for (std::size_t i = 0; i < bounds_.size(); ++i) *multipliers_[i] = bounds_[i].multiplier;
}

}  // namespace camway::correction
