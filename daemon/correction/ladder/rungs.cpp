// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/rungs.h"

#include <utility>

#include "daemon/correction/path/closeness.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;

// Chosen by measurement; none changes what is proved.
constexpr int kStepsPerLeg = 48;  // steps of relaxation per interval with a collision
/// Collisions that are nearer than so many spacings of knots get one row of bumps.
constexpr double kNearSpacings = 2.0;
/// A move that shifts the picture by more, on average between two keyframes, is compared with a way
/// round. [Units: radians]
constexpr double kDearMove_rad = 0.08;
/// A turn costs so much more than a move that shifts the picture as far: it changes what is seen.
constexpr double kTurnPenalty = 3.0;

}  // namespace

Rungs::Rungs(FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions,
             const motion::TimeOrigin& origin, std::uint64_t seed)
    : space_(space),
      corrected_(corrected),
      collisions_(collisions),
      origin_(origin),
      seed_(seed),
      budget_(kStepsPerLeg * static_cast<std::int64_t>(collisions.count_legs())) {}

bool Rungs::move_away(std::size_t index) {
  const double near_s = kNearSpacings * space_.closeness().best_spacing_s(space_.ball_radius_m());
  const std::vector<std::size_t> group = collisions_.open_near(index, near_s);
  if (group.size() > 1 && take_move(group, nudged(group, NudgeKind::kMove))) return true;
  const std::span<const std::size_t> first(group.data(), 1);
  return take_move(first, nudged(first, NudgeKind::kMove));
}

// Takes the move, or a way round that replaces it for less.
bool Rungs::take_move(std::span<const std::size_t> group, const std::optional<Candidate>& moved) {
  if (!moved) return false;
  const std::optional<Candidate> round = way_instead_of(*moved, group);
  if (round && corrected_.fits(*round)) return accept(group, CorrectionKind::kGoRound, round);
  return accept(group, CorrectionKind::kMove, moved);
}

// A way round costs a search, so it is looked for only where the move is dear, and where it
// replaces no correction of other collisions.
std::optional<Candidate> Rungs::way_instead_of(const Candidate& moved,
                                               std::span<const std::size_t> group) {
  if (collisions_.open_in(collisions_[group.front()].leg).size() > group.size())
    return std::nullopt;
  const Problem problem = this->problem(group);
  const double moved_cost = cost(group.front(), moved);
  if (moved_cost <= kDearMove_rad * (problem.leg_end_s() - problem.leg_begin_s())) {
    return std::nullopt;
  }
  DetourResult round = go_round(problem, Search::kQuick, budget_, space_, seed_, {}, deadline());
  collisions_[group.front()].correction.tried += round.effort;
  if (!round.candidate || cost(group.front(), *round.candidate) >= moved_cost) return std::nullopt;
  return std::move(round.candidate);
}

std::optional<Candidate> Rungs::turned(std::size_t index) {
  return space_.may_turn() ? nudged({&index, 1}, NudgeKind::kTurn) : std::nullopt;
}

void Rungs::take_turn(std::size_t index, const std::optional<Candidate>& turned) {
  accept({&index, 1}, CorrectionKind::kTurn, turned);
}

double Rungs::most_cost_instead_of(std::size_t index,
                                   const std::optional<Candidate>& turned) const {
  return turned ? kTurnPenalty * cost(index, *turned) : std::numeric_limits<double>::infinity();
}

Rungs::Replaced Rungs::replace_leg(std::size_t index, Search search, const ProofsOfNoWay& proofs,
                                   double most_cost) {
  const std::vector<std::size_t> same_leg = collisions_.open_in(collisions_[index].leg);
  DetourResult found =
      go_round(problem(same_leg), search, budget_, space_, seed_, proofs, deadline());
  collisions_[same_leg.front()].correction.tried += found.effort;
  if (found.candidate && cost(index, *found.candidate) > most_cost) {
    return {true, std::move(found.pocket)};
  }
  return {accept(same_leg, CorrectionKind::kGoRound, found.candidate), std::move(found.pocket)};
}

double Rungs::cost(std::size_t index, const Candidate& candidate) const {
  return closeness_cost(candidate.path, problem({&index, 1}).original, space_.closeness());
}

// The part of the path that may change for some collisions between the same keyframes, in order of
// time.
Problem Rungs::problem(std::span<const std::size_t> group) const {
  Problem problem = collisions_.with_open_collisions(
      corrected_.part_about(collisions_[group.front()].leg, origin_, space_.ball_radius_m()));
  problem.interval = collisions_[group.front()].correction.interval;
  problem.interval.t_end_s = collisions_[group.back()].correction.interval.t_end_s;
  for (const std::size_t i : group) {
    std::erase(problem.foreign_collisions, collisions_[i].correction.interval);
  }
  return problem;
}

std::optional<Candidate> Rungs::nudged(std::span<const std::size_t> group, NudgeKind nudge_kind) {
  std::vector<CollisionInterval> intervals;
  for (const std::size_t i : group) intervals.push_back(collisions_[i].correction.interval);
  NudgeResult found = nudge(problem(group), intervals, nudge_kind, budget_, space_, deadline());
  collisions_[group.front()].correction.tried += found.effort;
  return std::move(found.candidate);
}

// Takes a correction of some collisions, unless that would exceed the limit of keyframes.
bool Rungs::accept(std::span<const std::size_t> group, CorrectionKind kind,
                   const std::optional<Candidate>& candidate) {
  if (!candidate) return false;
  const bool is_taken = corrected_.take(*candidate);
  if (!is_taken) corrected_.count_refused(*candidate);
  const auto [begin_s, end_s] = corrected_.range_of(*candidate);
  for (const std::size_t i : group) {
    collisions_[i].is_beyond_limit = !is_taken;
    Correction& correction = collisions_[i].correction;
    if (is_taken) correction = {correction.interval, kind, begin_s, end_s};
  }
  return is_taken;
}

}  // namespace camway::correction
