// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/collision_list.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "daemon/base/largest_value.h"

namespace camway::correction {

using collision::CollisionInterval;
using motion::CubicPath;

namespace {

std::size_t leg_of(const CollisionInterval& interval, const std::vector<double>& keyframes_s) {
  const double middle_s = 0.5 * (interval.t_begin_s + interval.t_end_s);
  const auto next = std::ranges::upper_bound(keyframes_s, middle_s);
  const auto index = static_cast<std::size_t>(next - keyframes_s.begin());
  return std::clamp<std::size_t>(index, 1, keyframes_s.size() - 1) - 1;
}

void measure(const CubicPath& path, const CubicPath& interpolated, const Closeness& closeness,
             Correction& correction) {
  constexpr int kSamples = 6;  // of a piece
  const CubicPath changed = path.around(correction.t_begin_s, correction.t_end_s);
  correction.shift = shift_of(changed, interpolated, closeness);
  std::vector<double> times_s = {correction.t_begin_s};
  for (const motion::CubicPiece& piece : changed.pieces) {
    const double begin_s = std::max(piece.t0_s, correction.t_begin_s);
    const double end_s = std::min(piece.t1_s, correction.t_end_s);
    // Each once: the search for the largest value goes on to the next time on either side.
    for (int i = 1; i <= kSamples; ++i) {
      times_s.push_back(std::lerp(begin_s, end_s, static_cast<double>(i) / kSamples));
    }
  }
  correction.moved_m = base::largest_value(times_s, [&](double time_s) {
    return (changed.at(time_s).position - interpolated.at(time_s).position).norm();
  });
  correction.turned_rad = base::largest_value(times_s, [&](double time_s) {
    return changed.pose(time_s).orientation.angularDistance(interpolated.pose(time_s).orientation);
  });
}

}  // namespace

CollisionList::CollisionList(const std::vector<CollisionInterval>& collisions,
                             const std::vector<double>& keyframes_s) {
  const auto add = [&](const CollisionInterval& interval) {
    list_.push_back({{interval}, leg_of(interval, keyframes_s)});
  };
  for (CollisionInterval rest : collisions) {
    auto next = std::ranges::upper_bound(keyframes_s, rest.t_begin_s);
    for (; next != keyframes_s.end() && *next < rest.t_end_s; ++next) {
      CollisionInterval before = rest;
      before.t_end_s = *next;
      add(before);
      rest.t_begin_s = *next;
    }
    add(rest);
  }
}

std::size_t CollisionList::count_open() const {
  return static_cast<std::size_t>(std::ranges::count_if(list_, &ListedCollision::is_open));
}

bool CollisionList::any_without_way() const {
  return std::ranges::any_of(list_, [](const ListedCollision& listed) {
    return listed.is_open() && !listed.is_beyond_limit;
  });
}

std::vector<std::size_t> CollisionList::open_in(std::size_t leg) const {
  // Not std::ranges::equal_range: Clang 14 cannot compile its result with the library of GCC 12.
  const auto first = std::ranges::lower_bound(list_, leg, {}, &ListedCollision::leg);
  std::vector<std::size_t> open;
  for (auto listed = first; listed != list_.end() && listed->leg == leg; ++listed) {
    if (listed->is_open()) open.push_back(static_cast<std::size_t>(listed - list_.begin()));
  }
  return open;
}

std::vector<std::size_t> CollisionList::open_near(std::size_t index, double near_s) const {
  std::vector<std::size_t> group = {index};
  for (std::size_t i = index + 1; i < size(); ++i) {
    const ListedCollision& last = list_[group.back()];
    const ListedCollision& next = list_[i];
    const double between_s = next.correction.interval.t_begin_s - last.correction.interval.t_end_s;
    if (!next.is_open() || next.leg != last.leg || between_s > near_s) break;
    group.push_back(i);
  }
  return group;
}

std::size_t CollisionList::count_legs() const {
  std::set<std::size_t> legs;
  for (const ListedCollision& listed : list_) legs.insert(listed.leg);
  return legs.size();
}

Problem CollisionList::with_open_collisions(Problem part) const {
  // Collisions outside of the part are skipped: there may be thousands.
  const auto end_s = [](const ListedCollision& listed) {
    return listed.correction.interval.t_end_s;
  };
  auto next = std::ranges::lower_bound(list_, part.path.begin_s(), {}, end_s);
  for (; next != list_.end() && next->correction.interval.t_begin_s <= part.path.end_s(); ++next) {
    if (next->is_open()) part.foreign_collisions.push_back(next->correction.interval);
  }
  return part;
}

std::vector<bool> CollisionList::corrected_legs(const CorrectedPath& corrected) const {
  std::vector<bool> legs(corrected.keyframes_s().size() - 1);
  for (const ListedCollision& listed : list_) {
    const Correction& correction = listed.correction;
    if (!listed.is_open()) corrected.mark_legs(correction.t_begin_s, correction.t_end_s, legs);
  }
  return legs;
}

void CollisionList::widen(double begin_s, double end_s, const std::pair<double, double>& range_s) {
  for (ListedCollision& listed : list_) {
    Correction& correction = listed.correction;
    const bool is_here = correction.t_begin_s < end_s && correction.t_end_s > begin_s;
    if (listed.is_open() || !is_here) continue;
    correction.t_begin_s = std::min(correction.t_begin_s, range_s.first);
    correction.t_end_s = std::max(correction.t_end_s, range_s.second);
  }
}

void CollisionList::set_range(const ChangedPart& part, const std::pair<double, double>& range_s) {
  const auto end_s = [](const ListedCollision& listed) {
    return listed.correction.interval.t_end_s;
  };
  auto next = std::ranges::lower_bound(list_, part.begin_s, {}, end_s);
  for (; next != list_.end() && next->correction.interval.t_begin_s <= part.end_s; ++next) {
    Correction& correction = next->correction;
    const bool is_here = correction.t_begin_s >= part.begin_s && correction.t_end_s <= part.end_s;
    if (next->is_open() || !is_here) continue;
    correction.t_begin_s = range_s.first;
    correction.t_end_s = range_s.second;
  }
}

std::vector<Correction> CollisionList::corrections() const {
  std::vector<Correction> corrections;
  corrections.reserve(list_.size());
  for (const ListedCollision& listed : list_) corrections.push_back(listed.correction);
  return corrections;
}

void measure_corrections(const CubicPath& path, const CubicPath& interpolated,
                         const Closeness& closeness, std::vector<Correction>& corrections) {
  // Corrections of one interval between keyframes often have the same time range.
  std::map<std::pair<double, double>, const Correction*> measured;
  for (Correction& correction : corrections) {
    if (correction.kind == CorrectionKind::kNone) continue;
    const auto [same, is_new] =
        measured.try_emplace({correction.t_begin_s, correction.t_end_s}, &correction);
    if (is_new) measure(path, interpolated, closeness, correction);
    correction.moved_m = same->second->moved_m;
    correction.turned_rad = same->second->turned_rad;
    correction.shift = same->second->shift;
  }
}

}  // namespace camway::correction
