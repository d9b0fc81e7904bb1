// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/ladder.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "daemon/base/budget.h"
#include "daemon/correction/infeasibility/prover.h"
#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/ladder/detour.h"
#include "daemon/correction/ladder/nudge.h"
#include "daemon/correction/ladder/polish.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;

constexpr int kStepsPerLeg = 12;  // steps of relaxation per interval with a collision

class Ladder {
 public:
  Ladder(const scene::WholeMesh& mesh, FreeSpace& space,
         const std::vector<motion::Keyframe>& keyframes, const CubicPath& path,
         const std::vector<CollisionInterval>& collisions, const LadderOptions& options,
         const base::Deadline& deadline)
      : space_(space),
        options_(options),
        corrected_(path, keyframes,
                   {options.max_inserted_keyframes, space.detect().tolerance_m,
                    space.body().radius_m(), options.rest_s_per_piece},
                   deadline),
        collisions_(collisions, corrected_.keyframes_s()),
        prover_(mesh, space.body(), keyframes, options.max_shrink),
        budget_(kStepsPerLeg * static_cast<std::int64_t>(collisions_.count_legs())) {}

  LadderResult run() && {
    const bool is_corrected = options_.max_inserted_keyframes > 0 && correct();
    LadderResult result;
    result.timed_out = timed_out_;
    if (is_corrected) {
      polish(options_.objective, options_.origin, budget_, space_, corrected_, collisions_);
      result.needed_keyframes = corrected_.needed_keyframes();
    }
    result.corrections = collisions_.corrections();
    if (is_corrected) {
      measure_corrections(corrected_.path(), corrected_.interpolated(), result.corrections);
    }
    result.separation = prover_.separation();
    result.cage = prover_.cage();
    result.shut_in = std::move(shut_in_);
    result.inserted_s.assign(corrected_.inserted_s().begin(), corrected_.inserted_s().end());
    result.path = std::move(corrected_).release();
    return result;
  }

 private:
  // Returns false if it was proved that there is no path.
  bool correct() {
    correct_all(Search::kWithRoom);
    if (prover_.has_proof()) return false;
    if (collisions_.any_without_way() && !deadline().passed()) {
      if (!prover_.is_separated() && !deadline().passed()) prover_.look_for_cage();
      if (prover_.has_proof()) return false;
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
      if (search == Search::kWithRoom && (nudge_away(i) || collision.is_beyond_limit)) continue;
      const std::size_t leg = collision.leg;
      // A detour replaces the whole interval between keyframes: do not search it twice.
      if (is_shut_off(leg) || prover_.is_caged_off(center_W(leg), center_W(leg + 1))) {
        has_no_way[leg] = true;
      }
      if (!has_no_way[leg]) has_no_way[leg] = !replace_leg(i, search);
    }
  }

  // The part of the path that may change for a collision.
  [[nodiscard]] Problem problem(std::size_t index) const {
    const CollisionInterval& interval = collisions_[index].correction.interval;
    Problem problem = collisions_.with_open_collisions(
        corrected_.part_about(collisions_[index].leg, options_.origin, space_.ball_radius_m()));
    problem.interval = interval;
    std::erase(problem.foreign_collisions, interval);
    return problem;
  }

  bool nudge_away(std::size_t index) {
    const Problem problem = this->problem(index);
    if (nudge_away(index, problem, NudgeKind::kMove)) return true;
    if (!space_.may_turn() || collisions_[index].is_beyond_limit) return false;
    return nudge_away(index, problem, NudgeKind::kTurn);
  }

  bool nudge_away(std::size_t index, const Problem& problem, NudgeKind nudge_kind) {
    const NudgeResult found = nudge(problem, nudge_kind, space_, deadline());
    collisions_[index].correction.tried += found.effort;
    const bool is_move = nudge_kind == NudgeKind::kMove;
    return accept(index, is_move ? CorrectionKind::kMove : CorrectionKind::kTurn, found.candidate);
  }

  // A detour replaces everything between the two keyframes.
  bool replace_leg(std::size_t index, Search search) {
    Problem problem = this->problem(index);
    const std::size_t leg = collisions_[index].leg;
    const std::vector<std::size_t> same_leg = collisions_.open_in(leg);
    std::erase_if(problem.foreign_collisions, [&](const CollisionInterval& other) {
      return std::ranges::any_of(
          same_leg, [&](std::size_t i) { return collisions_[i].correction.interval == other; });
    });
    const DetourResult found = go_round(
        problem, search, budget_, space_, options_.seed, [this] { return prover_.is_separated(); },
        deadline());
    if (found.pocket) add_shut_in(leg + (found.pocket->is_at_end ? 1 : 0), *found.pocket);
    for (const std::size_t i : same_leg) collisions_[i].correction.tried += found.effort;
    const bool is_accepted = accept(index, CorrectionKind::kGoRound, found.candidate);
    for (const std::size_t i : same_leg) {
      const CollisionInterval interval = collisions_[i].correction.interval;
      if (is_accepted) collisions_[i].correction = collisions_[index].correction;
      collisions_[i].correction.interval = interval;
      collisions_[i].is_beyond_limit = collisions_[index].is_beyond_limit;
    }
    return is_accepted;
  }

  // Takes a correction, unless that would exceed the limit of keyframes.
  bool accept(std::size_t index, CorrectionKind kind, const std::optional<Candidate>& candidate) {
    if (!candidate) return false;
    ListedCollision& collision = collisions_[index];
    if (!corrected_.take(*candidate)) {
      collision.is_beyond_limit = true;
      corrected_.count_refused(*candidate);
      return false;
    }
    collision.correction.kind = kind;
    collision.correction.tried = {};
    const auto [begin_s, end_s] = corrected_.range_of(*candidate);
    collision.correction.t_begin_s = begin_s;
    collision.correction.t_end_s = end_s;
    deadline().report_collisions(collisions_.size(), collisions_.size() - collisions_.count_open());
    return true;
  }

  // Whether an earlier search found that one end is shut in and cannot reach the other.
  [[nodiscard]] bool is_shut_off(std::size_t leg) const {
    return std::ranges::any_of(shut_in_, [&](const ShutIn& known) {
      return (known.keyframe == leg && !known.may_hold(center_W(leg + 1))) ||
             (known.keyframe == leg + 1 && !known.may_hold(center_W(leg)));
    });
  }

  void add_shut_in(std::size_t keyframe, const Pocket& pocket) {
    const auto same = std::ranges::find(shut_in_, keyframe, &ShutIn::keyframe);
    if (same != shut_in_.end()) return;
    shut_in_.push_back({keyframe, pocket.reached_W, pocket.unsure_m});
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
  std::vector<ShutIn> shut_in_;
  bool timed_out_ = false;
};

}  // namespace

LadderResult correct_by_ladder(const scene::WholeMesh& mesh, const collision::Query& query,
                               const std::vector<motion::Keyframe>& keyframes,
                               const CubicPath& path,
                               const std::vector<CollisionInterval>& collisions,
                               const LadderOptions& options, const base::Deadline& deadline) {
  FreeSpace space(query, options.orientation);
  return Ladder(mesh, space, keyframes, path, collisions, options, deadline).run();
}

}  // namespace camway::correction
