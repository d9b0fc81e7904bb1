// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/more_room.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/collision/detect.h"
#include "daemon/correction/ladder/redraw.h"
#include "daemon/correction/ladder/rungs.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr double kKeptShare = 0.95;   // share of the keyframes' gap that is asked for first
constexpr double kWorth = 1.05;       // least growth of the least gap
constexpr double kMostShift = 2.0;    // times the shift of the corrections and of `kComfort`
constexpr int kAttempts = 5;          // with different clearances, for each range
constexpr double kNextShare = 0.4;    // of the way to the gap that failed: the next one
constexpr double kLeastShare = 0.01;  // of the gap that failed: the least that is tried

/// Intervals between keyframes that no changed part joins to others.
struct LegRange {
  std::size_t first_keyframe = 0;
  std::size_t last_keyframe = 0;
  bool turns = false;      ///< whether a changed part turns the body
  double shift_rad = 0.0;  ///< largest shift of the corrections
};

class RoomMaker {
 public:
  RoomMaker(const motion::TimeOrigin& origin, std::uint64_t seed, FreeSpace& space,
            CorrectedPath& corrected, CollisionList& collisions)
      : origin_(origin),
        seed_(seed),
        space_(space),
        corrected_(corrected),
        collisions_(collisions),
        keyframes_s_(corrected.keyframes_s()) {}

  bool run() {
    bool gains = false;
    std::size_t done = 0;  // keyframe up to which all intervals were looked at
    for (std::size_t i = 0; i < collisions_.size() && !deadline().passed(); ++i) {
      if (collisions_[i].is_open() || collisions_[i].leg < done) continue;
      LegRange legs = range_about(collisions_[i].leg);
      legs.shift_rad = shift_rad(corrected_, legs);
      // A new correction may have reached over from an earlier range.
      const bool is_new = legs.first_keyframe >= done;
      if (is_new && !has_open_collision(legs) && widen(legs)) gains = true;
      done = legs.last_keyframe;
    }
    return gains;
  }

 private:
  [[nodiscard]] LegRange range_about(std::size_t leg) const {
    LegRange legs{leg, leg + 1};
    for (bool grows = true; grows;) {
      grows = false;
      for (const ChangedPart& part : corrected_.changed_parts()) {
        if (!overlaps(part, legs)) continue;
        grows |= extend(legs, part);
        legs.turns |= part.turns;
      }
    }
    return legs;
  }

  /// Extends the range to the keyframes about a changed part; returns whether it was shorter.
  bool extend(LegRange& legs, const ChangedPart& part) const {
    const LegRange before = legs;
    while (legs.first_keyframe > 0 && part.begin_s < keyframes_s_[legs.first_keyframe]) {
      --legs.first_keyframe;
    }
    while (legs.last_keyframe + 1 < keyframes_s_.size() &&
           part.end_s > keyframes_s_[legs.last_keyframe]) {
      ++legs.last_keyframe;
    }
    return legs.first_keyframe < before.first_keyframe || legs.last_keyframe > before.last_keyframe;
  }

  [[nodiscard]] bool has_open_collision(const LegRange& legs) const {
    for (std::size_t leg = legs.first_keyframe; leg < legs.last_keyframe; ++leg) {
      if (!collisions_.open_in(leg).empty()) return true;
    }
    return false;
  }

  [[nodiscard]] bool overlaps(const ChangedPart& part, const LegRange& legs) const {
    return part.begin_s < keyframes_s_[legs.last_keyframe] &&
           part.end_s > keyframes_s_[legs.first_keyframe];
  }

  /// Asks for the largest gap first. Then divides the range between the least gap that is known and
  /// one that failed, on a logarithmic scale until an attempt succeeds.
  bool widen(const LegRange& legs) {
    double kept_m = least_gap_m(corrected_, legs);
    double tried_m = most_gap_m(legs);
    double failed_m = tried_m;
    const CorrectedPath before = corrected_;
    bool gains = false;
    for (int i = 0; i < kAttempts && failed_m > kWorth * kept_m && !deadline().passed(); ++i) {
      if (!attempt(legs, before, tried_m, kept_m)) {
        failed_m = tried_m;
      } else if (i == 0) {
        return true;
      } else {
        gains = true;
      }
      tried_m = gains ? std::lerp(kept_m, failed_m, kNextShare)
                      : std::sqrt(std::max(kept_m, kLeastShare * failed_m) * failed_m);
    }
    return gains;
  }

  /// The largest gap that is worth asking for: no path has more than its keyframes.
  [[nodiscard]] double most_gap_m(const LegRange& legs) const {
    collision::Query query = space_.query();
    query.obstacles.bounds = {};  // a clearance is about the scene alone
    FreeSpace space(query);
    double most_m = kComfort * space.ball_radius_m();
    for (std::size_t i = legs.first_keyframe; i <= legs.last_keyframe; ++i) {
      const motion::Pose pose = corrected_.interpolated().pose(keyframes_s_[i]);
      most_m = std::min(most_m, kKeptShare * space.gap_m(pose, most_m));
    }
    return most_m;
  }

  /// Least gap over the legs. What a correction changes beside them keeps the gap asked for.
  [[nodiscard]] double least_gap_m(const CorrectedPath& path, const LegRange& legs) {
    const double begin_s = keyframes_s_[legs.first_keyframe];
    const double end_s = keyframes_s_[legs.last_keyframe];
    const CubicPath part = path.path().around(begin_s, end_s);
    return objective_cost(Objective::kSafest, part, part, space_, deadline()).least_gap_m;
  }

  /// Largest shift of the legs from the path as interpolated.
  [[nodiscard]] double shift_rad(const CorrectedPath& path, const LegRange& legs) const {
    const CubicPath part =
        path.path().around(keyframes_s_[legs.first_keyframe], keyframes_s_[legs.last_keyframe]);
    return shift_of(part, path.interpolated(), space_.closeness()).largest_rad;
  }

  /// Room is no reason to leave the shot: a way that leads much farther off is not taken.
  [[nodiscard]] bool leads_too_far(const CorrectedPath& path, const LegRange& legs) const {
    const Closeness& closeness = space_.closeness();
    const double comfort_rad = kComfort * space_.ball_radius_m() / closeness.viewing_distance_m;
    return shift_rad(path, legs) > kMostShift * (legs.shift_rad + comfort_rad);
  }

  /// Moves the corrected path, or else corrects the path as interpolated anew, so that the legs
  /// have a gap. Raises `kept_m` if the result replaces the path. `before`: the path before all
  /// attempts. Theirs may reach beyond the legs, so it is not in `corrected_` that the legs can
  /// become as interpolated.
  bool attempt(const LegRange& legs, const CorrectedPath& before, double gap_m, double& kept_m) {
    collision::Query query = space_.query();
    query.options.clearance_m += gap_m;
    OrientationPolicy policy = space_.policy();
    if (!legs.turns) policy.max_turn_rad = 0.0;
    FreeSpace roomy(query, policy, space_.closeness());
    CorrectedPath anew = before;
    anew.restore(legs.first_keyframe, legs.last_keyframe);
    return attempt_on(corrected_, Method::kMoves, legs, roomy, kept_m) ||
           attempt_on(std::move(anew), Method::kAllRungs, legs, roomy, kept_m);
  }

  enum class Method { kMoves, kAllRungs };

  bool attempt_on(CorrectedPath path, Method method, const LegRange& legs, FreeSpace& roomy,
                  double& kept_m) {
    const std::size_t others = path.changed_parts().size() - parts_of(path, legs).size();
    const double begin_s = keyframes_s_[legs.first_keyframe];
    const double end_s = keyframes_s_[legs.last_keyframe];
    const std::optional<std::vector<CollisionInterval>> found = collision::detect_collisions(
        roomy.query(), path.path().around(begin_s, end_s).path(), begin_s, end_s, deadline());
    if (!found || found->empty()) return false;
    CollisionList list(*found, keyframes_s_);
    // Narrow places, where the body must turn, are found by a costlier search alone.
    const Search search = legs.turns ? Search::kWithRoom : Search::kQuick;
    const bool is_corrected = method == Method::kMoves ? moves_away(roomy, path, list)
                                                       : correct(search, roomy, path, list);
    if (!is_corrected) return false;
    const std::vector<ChangedPart> parts = parts_of(path, legs);
    if (path.changed_parts().size() != others + parts.size()) return false;
    redraw(parts, origin_, roomy, path, list);
    const double least_m = least_gap_m(path, legs);
    if (least_m < kWorth * kept_m || leads_too_far(path, legs)) return false;
    kept_m = least_m;
    take(method, legs, std::move(path), list);
    return true;
  }

  [[nodiscard]] std::vector<ChangedPart> parts_of(const CorrectedPath& path,
                                                  const LegRange& legs) const {
    std::vector<ChangedPart> parts;
    std::ranges::copy_if(path.changed_parts(), std::back_inserter(parts),
                         [&](const ChangedPart& part) { return overlaps(part, legs); });
    return parts;
  }

  /// Moves the body away at all collisions of the list; returns false if one is left.
  bool moves_away(FreeSpace& space, CorrectedPath& path, CollisionList& list) const {
    Rungs rungs(space, path, list, origin_, seed_);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].is_open() && !rungs.move_away(i)) return false;
    }
    return true;
  }

  /// Corrects all collisions of the list; returns false if one is left.
  bool correct(Search search, FreeSpace& space, CorrectedPath& path, CollisionList& list) const {
    Rungs rungs(space, path, list, origin_, seed_);
    // A path is known, so nobody needs a proof that there is none.
    const ProofsOfNoWay none{[] { return false; }, [] { return false; }};
    for (std::size_t i = 0; i < list.size() && !path.deadline().passed(); ++i) {
      if (!list[i].is_open() || rungs.move_away(i)) continue;
      const std::optional<Candidate> turned = rungs.turned(i);
      rungs.replace_leg(i, search, none, rungs.most_cost_instead_of(i, turned));
      if (list[i].is_open()) rungs.take_turn(i, turned);
      if (list[i].is_open()) return false;
    }
    return list.count_open() == 0;
  }

  /// Takes the path over. Corrections are as long as the changed parts that hold them. After
  /// `kAllRungs`, they are of the kind of the collision in `list` that holds theirs: a larger
  /// clearance only lengthens collisions.
  void take(Method method, const LegRange& legs, CorrectedPath&& path, const CollisionList& list) {
    corrected_.adopt(std::move(path));
    const std::vector<ChangedPart> parts = parts_of(corrected_, legs);
    auto part = parts.begin();
    std::size_t wider = 0;
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
      const std::size_t leg = collisions_[i].leg;
      if (leg < legs.first_keyframe || leg >= legs.last_keyframe) continue;
      Correction& correction = collisions_[i].correction;
      const double middle_s = 0.5 * (correction.interval.t_begin_s + correction.interval.t_end_s);
      while (part + 1 != parts.end() && part->end_s < middle_s) ++part;
      while (wider + 1 < list.size() && list[wider].correction.interval.t_end_s < middle_s) ++wider;
      const bool is_new = method == Method::kAllRungs;
      correction = {correction.interval, is_new ? list[wider].correction.kind : correction.kind,
                    part->begin_s, part->end_s};
    }
  }

  [[nodiscard]] const base::Deadline& deadline() const { return corrected_.deadline(); }

  const motion::TimeOrigin& origin_;
  const std::uint64_t seed_;
  FreeSpace& space_;
  CorrectedPath& corrected_;
  CollisionList& collisions_;
  const std::vector<double>& keyframes_s_;
};

}  // namespace

bool make_more_room(const motion::TimeOrigin& origin, std::uint64_t seed, FreeSpace& space,
                    CorrectedPath& corrected, CollisionList& collisions) {
  return RoomMaker(origin, seed, space, corrected, collisions).run();
}

}  // namespace camway::correction
