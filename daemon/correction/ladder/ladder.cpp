// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/ladder.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "daemon/base/budget.h"
#include "daemon/correction/infeasibility/prover.h"
#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/ladder/detour.h"
#include "daemon/correction/ladder/nudge.h"
#include "daemon/correction/ladder/polish.h"
#include "daemon/correction/ladder/redraw.h"
#include "daemon/correction/ladder/shut_in_list.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/viewing_distance.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;

constexpr int kStepsPerLeg = 48;  // steps of relaxation per interval with a collision
/// Collisions that are nearer than so many spacings of knots get one row of bumps.
constexpr double kNearSpacings = 2.0;
/// A turn costs so much more than a move that shifts the picture as far: it changes what is seen.
constexpr double kTurnPenalty = 3.0;

class Ladder {
 public:
  Ladder(const scene::WholeMesh& mesh, FreeSpace& space,
         const std::vector<motion::Keyframe>& keyframes, const CubicPath& path,
         const std::vector<CollisionInterval>& collisions, const LadderOptions& options,
         const base::Deadline& deadline)
      : space_(space),
        options_(options),
        corrected_(path, keyframes, {options.max_inserted_keyframes, options.rest_s_per_piece},
                   deadline),
        collisions_(collisions, corrected_.keyframes_s()),
        prover_(mesh, space.body(), keyframes, options.max_shrink),
        budget_(kStepsPerLeg * static_cast<std::int64_t>(collisions_.count_legs())) {}

  LadderResult run() && {
    const bool is_corrected = options_.max_inserted_keyframes > 0 && correct();
    LadderResult result;
    result.timed_out = timed_out_;
    if (is_corrected) {
      // Counted before the redrawing, which spares keyframes of the corrections taken, but not of
      // those that were refused.
      result.needed_keyframes = corrected_.needed_keyframes();
      redraw(options_.origin, space_, corrected_, collisions_);
      result.is_polished =
          polish(options_.objective, options_.origin, space_, corrected_, collisions_);
    }
    result.corrections = collisions_.corrections();
    if (is_corrected) {
      measure_corrections(corrected_.path(), corrected_.interpolated(), space_.closeness(),
                          result.corrections);
    }
    result.separation = prover_.separation();
    result.cage = prover_.cage();
    result.shut_in =
        shut_in_.all([this](std::size_t leg) { return !collisions_.open_in(leg).empty(); });
    result.inserted_s = corrected_.inserted_s();
    result.closeness = space_.closeness();
    result.path = std::move(corrected_).release();
    return result;
  }

 private:
  // Returns false if it was proved that there is no path.
  bool correct() {
    correct_all(Search::kWithRoom);
    if (prover_.has_proof()) return false;
    if (collisions_.any_without_way() && !deadline().passed()) {
      if (prover_.is_separated()) return false;
      if (!deadline().passed() && prover_.is_caged()) return false;
      if (space_.may_turn()) correct_all(Search::kTurning);
    }
    timed_out_ = collisions_.count_open() > 0 && deadline().passed();
    return true;
  }

  void correct_all(Search search) {
    // Between a keyframe and the next.
    std::vector<bool> has_no_way(corrected_.keyframes_s().size(), false);
    for (std::size_t i = 0; i < collisions_.size() && !deadline().passed(); ++i) {
      const ListedCollision& collision = collisions_[i];
      if (!collision.is_open() || collision.is_beyond_limit) continue;
      if (prover_.has_proof()) return;
      if (search == Search::kWithRoom && (move_away(i) || collision.is_beyond_limit)) continue;
      const std::size_t leg = collision.leg;
      // A detour replaces the whole interval between keyframes: do not search it twice.
      if (is_cut_off(leg)) has_no_way[leg] = true;
      if (search == Search::kWithRoom) {
        turn_or_replace(i, has_no_way);
      } else if (!has_no_way[leg]) {
        has_no_way[leg] = shut_in_.is_worthless(leg) || !replace_leg(i, search);
        shut_in_.mark_searched(leg);
      }
    }
  }

  // Moves the camera aside for a group of collisions, or else for its first one.
  bool move_away(std::size_t index) {
    const double near_s = kNearSpacings * space_.closeness().best_spacing_s(space_.ball_radius_m());
    const std::vector<std::size_t> group = collisions_.open_near(index, near_s);
    if (group.size() > 1 && accept(group, CorrectionKind::kMove, nudged(group, NudgeKind::kMove))) {
      return true;
    }
    const std::span<const std::size_t> first(group.data(), 1);
    return accept(first, CorrectionKind::kMove, nudged(first, NudgeKind::kMove));
  }

  // Turns the camera, or takes a detour that keeps its orientation, whichever costs less.
  void turn_or_replace(std::size_t index, std::vector<bool>& has_no_way) {
    const std::size_t leg = collisions_[index].leg;
    const std::optional<Candidate> turned =
        space_.may_turn() ? nudged({&index, 1}, NudgeKind::kTurn) : std::nullopt;
    const double most_cost =
        turned ? kTurnPenalty * cost(index, *turned) : std::numeric_limits<double>::infinity();
    if (!has_no_way[leg]) {
      has_no_way[leg] = !replace_leg(index, Search::kWithRoom, most_cost) && !turned;
    }
    if (collisions_[index].is_open()) accept({&index, 1}, CorrectionKind::kTurn, turned);
  }

  [[nodiscard]] double cost(std::size_t index, const Candidate& candidate) const {
    return closeness_cost(candidate.path, problem(index).original, space_.closeness());
  }

  // The part of the path that may change for some collisions between the same keyframes, in order
  // of time.
  [[nodiscard]] Problem problem(std::span<const std::size_t> group) const {
    Problem problem = collisions_.with_open_collisions(corrected_.part_about(
        collisions_[group.front()].leg, options_.origin, space_.ball_radius_m()));
    problem.interval = collisions_[group.front()].correction.interval;
    problem.interval.t_end_s = collisions_[group.back()].correction.interval.t_end_s;
    for (const std::size_t i : group) {
      std::erase(problem.foreign_collisions, collisions_[i].correction.interval);
    }
    return problem;
  }
  [[nodiscard]] Problem problem(std::size_t index) const { return problem({&index, 1}); }

  std::optional<Candidate> nudged(std::span<const std::size_t> group, NudgeKind nudge_kind) {
    std::vector<CollisionInterval> intervals;
    for (const std::size_t i : group) intervals.push_back(collisions_[i].correction.interval);
    NudgeResult found = nudge(problem(group), intervals, nudge_kind, budget_, space_, deadline());
    for (const std::size_t i : group) collisions_[i].correction.tried += found.effort;
    return std::move(found.candidate);
  }

  // A detour replaces everything between the two keyframes. One that costs more than `most_cost`
  // is found, but not taken. Returns whether one was found.
  bool replace_leg(std::size_t index, Search search,
                   double most_cost = std::numeric_limits<double>::infinity()) {
    const std::size_t leg = collisions_[index].leg;
    const std::vector<std::size_t> same_leg = collisions_.open_in(leg);
    const Problem problem = this->problem(same_leg);
    const ProofsOfNoWay proofs{
        .is_separated = [this] { return prover_.is_separated(); },
        .is_caged =
            [this, leg] {
              return prover_.is_caged() || prover_.is_caged_off(center_W(leg), center_W(leg + 1));
            },
    };
    const DetourResult found =
        go_round(problem, search, budget_, space_, options_.seed, proofs, deadline());
    if (found.pocket) shut_in_.add(leg, *found.pocket);
    for (const std::size_t i : same_leg) collisions_[i].correction.tried += found.effort;
    if (found.candidate && cost(index, *found.candidate) > most_cost) return true;
    return accept(same_leg, CorrectionKind::kGoRound, found.candidate);
  }

  // Takes a correction of some collisions, unless that would exceed the limit of keyframes.
  bool accept(std::span<const std::size_t> corrected, CorrectionKind kind,
              const std::optional<Candidate>& candidate) {
    if (!candidate) return false;
    const bool is_taken = corrected_.take(*candidate);
    if (!is_taken) corrected_.count_refused(*candidate);
    const auto [begin_s, end_s] = corrected_.range_of(*candidate);
    for (const std::size_t i : corrected) {
      collisions_[i].is_beyond_limit = !is_taken;
      Correction& correction = collisions_[i].correction;
      if (is_taken) correction = {correction.interval, kind, begin_s, end_s};
    }
    if (!is_taken) return false;
    deadline().report_collisions(collisions_.size(), collisions_.size() - collisions_.count_open());
    return true;
  }

  // Whether earlier searches or cages show that no way joins the ends of an interval.
  [[nodiscard]] bool is_cut_off(std::size_t leg) const {
    const geometry::Vec3 begin_W = center_W(leg);
    const geometry::Vec3 end_W = center_W(leg + 1);
    return shut_in_.is_shut_off(leg, begin_W, end_W) || prover_.is_caged_off(begin_W, end_W);
  }

  // Centre of the body at a keyframe.
  [[nodiscard]] geometry::Vec3 center_W(std::size_t keyframe) const {
    return space_.center_W(corrected_.interpolated().pose(corrected_.keyframes_s()[keyframe]));
  }

  [[nodiscard]] const base::Deadline& deadline() const { return corrected_.deadline(); }

  FreeSpace& space_;
  const LadderOptions& options_;
  CorrectedPath corrected_;
  CollisionList collisions_;
  Prover prover_;
  base::Budget budget_;  ///< steps of the relaxation of detours, and then of polishing
  ShutInList shut_in_;
  bool timed_out_ = false;
};

}  // namespace

LadderResult correct_by_ladder(const scene::WholeMesh& mesh, const collision::Query& query,
                               const std::vector<motion::Keyframe>& keyframes,
                               const CubicPath& path,
                               const std::vector<CollisionInterval>& collisions,
                               const LadderOptions& options, const base::Deadline& deadline) {
  const Closeness closeness =
      closeness_of(path, FreeSpace(query, options.orientation), options.viewing_distance_m);
  FreeSpace space(query, options.orientation, closeness);
  return Ladder(mesh, space, keyframes, path, collisions, options, deadline).run();
}

}  // namespace camway::correction
