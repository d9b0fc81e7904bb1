// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/path_sample.h"

#include <algorithm>
#include <utility>

#include "daemon/correction/path/orientation_rule.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved.
constexpr double kLeastGap = 0.03;  // least gap that a step may leave, in radii of the ball, ...
constexpr double kKeptOfGap = 0.8;  // ... or this share of what there was, where that is less
constexpr double kRuleMargin = 0.3 * kOrientationAllowance_rad;  // least room at the samples
constexpr double kFarEnough = 0.5;  // share of the horizon beyond which a lower bound suffices
constexpr std::size_t kMostContacts = 3;  // contacts per sample
constexpr double kFacing = -0.5;  // cosine of the directions of contacts that face each other

double distance_m(const StackedPoint& a, const StackedPoint& b) {
  return (a.head<3>() - b.head<3>()).norm() + (a.tail<4>() - b.tail<4>()).norm();
}

/// Returns whether the contact is new.
bool add_contact(PathSample& sample, std::uint32_t triangle) {
  if (std::ranges::find(sample.contacts, triangle) != sample.contacts.end()) return false;
  sample.has_rows = false;
  sample.contacts.push_back(triangle);
  if (sample.contacts.size() > kMostContacts) sample.contacts.erase(sample.contacts.begin());
  return true;
}

/// Whether contacts push the body of the sample from opposite sides.
bool is_squeezed(const PathSample& sample) {
  const auto direction_W = [](const Contact& contact) -> geometry::Vec3 {
    return contact.row.direction.head<3>();
  };
  for (std::size_t i = 1; i < sample.rows.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (direction_W(sample.rows[i]).dot(direction_W(sample.rows[j])) < kFacing) return true;
    }
  }
  return false;
}

}  // namespace

SampleProbe::SampleProbe(const Problem& problem, FreeSpace& space, double lever_m, double horizon_m)
    : problem_(problem), space_(space), lever_m_(lever_m), horizon_m_(horizon_m) {}

std::optional<PathSample> SampleProbe::sample_at(double time_s, const FreeCoefficients& free,
                                                 const StackedPoints& variables) {
  if (time_s <= problem_.path.begin_s() || time_s >= problem_.path.end_s()) return std::nullopt;
  if (in_foreign_collision(time_s)) return std::nullopt;
  PathSample sample;
  sample.path = stacked(problem_.path.at(time_s), lever_m_);
  sample.terms = free.at(time_s);
  if (sample.terms.empty()) return std::nullopt;
  sample.interpolated = problem_.original.pose(time_s);
  measure(sample, sample.at(variables));
  const double room = rule_room(space_.policy(), pose(sample.known), sample.interpolated);
  sample.rule_floor = std::min(kRuleMargin, kKeptOfGap * std::max(0.0, room));
  sample.floor_m =
      std::min(kLeastGap * space_.ball_radius_m(), kKeptOfGap * std::max(0.0, sample.known_gap_m));
  return sample;
}

void SampleProbe::measure(PathSample& sample, const StackedPoint& there) {
  SampleCheck ignored;
  sample.known = there;
  sample.known_gap_m = gap_m(sample, there, ignored);
}

SampleCheck SampleProbe::check(PathSample& sample, const StackedPoint& there) {
  if (!meets_rule(sample, there)) return {.is_free = false, .breaks_rule = true};
  SampleCheck check;
  if (distance_m(there, sample.known) + sample.floor_m < sample.known_gap_m) return check;
  const double gap_m = this->gap_m(sample, there, check);
  check.is_free = gap_m > sample.floor_m;
  if (!check.is_free) {
    check.is_squeezed = is_squeezed(sample);
    return check;
  }
  sample.known = there;
  sample.known_gap_m = gap_m;
  return check;
}

void SampleProbe::update_rows(PathSample& sample, const StackedPoint& there, bool may_turn,
                              double beyond_m) {
  if (sample.has_rows) return;
  rows_.clear();
  add_contact_rows(space_, {there, problem_.path.reference, lever_m_, may_turn}, sample.contacts,
                   horizon_m_ + beyond_m, rows_);
  const std::vector<Contact> before = std::exchange(sample.rows, {});
  for (const ContactRow& row : rows_) {
    const auto same = std::ranges::find_if(before, [&](const Contact& contact) {
      return contact.row.triangle == row.triangle && contact.row.vertex == row.vertex;
    });
    sample.rows.push_back(same == before.end() ? Contact{row, 0.0, 0.0} : *same);
    sample.rows.back().row = row;
  }
  sample.has_rows = true;
}

// Returns about the gap of the body, at most `horizon_m_` or a lower bound beyond it, and adds a
// contact for the nearest obstacle.
double SampleProbe::gap_m(PathSample& sample, const StackedPoint& there, SampleCheck& check) {
  const motion::Pose pose = this->pose(there);
  const double at_least_m = space_.gap_at_least_m(pose);
  if (at_least_m > kFarEnough * horizon_m_) return at_least_m;
  const std::optional<scene::Nearest> nearest = space_.nearest(pose, horizon_m_);
  if (!nearest) return horizon_m_;
  check.found_contact = add_contact(sample, nearest->triangle);
  return nearest->distance_m;
}

motion::Pose SampleProbe::pose(const StackedPoint& point) const {
  return motion::pose_of(problem_.path.reference, unstacked(point, lever_m_));
}

bool SampleProbe::meets_rule(const PathSample& sample, const StackedPoint& there) const {
  if (!is_limited(space_.policy())) return true;
  return rule_room(space_.policy(), pose(there), sample.interpolated) >= sample.rule_floor;
}

bool SampleProbe::in_foreign_collision(double time_s) const {
  return std::ranges::any_of(problem_.foreign_collisions,
                             [&](const collision::CollisionInterval& other) {
                               return other.t_begin_s <= time_s && time_s <= other.t_end_s;
                             });
}

}  // namespace camway::correction
