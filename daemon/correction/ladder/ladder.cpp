// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/ladder.h"

#include <limits>
#include <utility>

#include "daemon/correction/infeasibility/prover.h"
#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/ladder/detour.h"
#include "daemon/correction/ladder/more_room.h"
#include "daemon/correction/ladder/polish.h"
#include "daemon/correction/ladder/redraw.h"
#include "daemon/correction/ladder/rungs.h"
#include "daemon/correction/ladder/shut_in_list.h"
#include "daemon/correction/path/viewing_distance.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;

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
        rungs_(space, corrected_, collisions_, options.origin, options.seed),
        prover_(mesh, space.body(), keyframes, options.max_shrink) {}

  LadderResult run() && {
    const bool is_corrected = options_.max_inserted_keyframes > 0 && correct();
    LadderResult result;
    result.timed_out = timed_out_;
    if (is_corrected) {
      // Counted before the redrawing, which spares keyframes of the corrections taken, but not of
      // those that were refused.
      result.needed_keyframes = corrected_.needed_keyframes();
      const std::vector<ChangedPart> parts = corrected_.changed_parts();
      redraw(parts, options_.origin, space_, corrected_, collisions_);
      if (options_.objective == Objective::kSafest) {
        result.is_polished =
            make_more_room(options_.origin, options_.seed, space_, corrected_, collisions_);
      }
      result.is_polished |=
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
      correct_all(Search::kNarrow);
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
      correct(i, search, has_no_way);
      if (!collision.is_open()) report_progress();
    }
  }

  void correct(std::size_t index, Search search, std::vector<bool>& has_no_way) {
    const bool is_moved = search == Search::kWithRoom && rungs_.move_away(index);
    if (is_moved || collisions_[index].is_beyond_limit) return;
    const std::size_t leg = collisions_[index].leg;
    // A detour replaces the whole interval between keyframes: do not search it twice.
    if (is_cut_off(leg)) has_no_way[leg] = true;
    if (search == Search::kWithRoom) {
      turn_or_replace(index, has_no_way);
    } else if (!has_no_way[leg]) {
      has_no_way[leg] = shut_in_.is_worthless(leg) || !replace_leg(index, search);
      shut_in_.mark_searched(leg);
    }
  }

  void report_progress() const {
    deadline().report_collisions(collisions_.size(), collisions_.size() - collisions_.count_open());
  }

  // Turns the camera, or takes a detour that keeps its orientation, whichever costs less.
  void turn_or_replace(std::size_t index, std::vector<bool>& has_no_way) {
    const std::size_t leg = collisions_[index].leg;
    const std::optional<Candidate> turned = rungs_.turned(index);
    if (!has_no_way[leg]) {
      const double most_cost = rungs_.most_cost_instead_of(index, turned);
      has_no_way[leg] = !replace_leg(index, Search::kWithRoom, most_cost) && !turned;
    }
    if (collisions_[index].is_open()) rungs_.take_turn(index, turned);
  }

  // Returns whether a detour was found that costs no more than `most_cost`, or a dearer one.
  bool replace_leg(std::size_t index, Search search,
                   double most_cost = std::numeric_limits<double>::infinity()) {
    const std::size_t leg = collisions_[index].leg;
    const ProofsOfNoWay proofs{
        .is_separated = [this] { return prover_.is_separated(); },
        .is_caged =
            [this, leg] {
              return prover_.is_caged() || prover_.is_caged_off(center_W(leg), center_W(leg + 1));
            },
    };
    const Rungs::Replaced replaced = rungs_.replace_leg(index, search, proofs, most_cost);
    if (replaced.pocket) shut_in_.add(leg, *replaced.pocket);
    return replaced.has_way;
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
  Rungs rungs_;
  Prover prover_;
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
