// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/redraw.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/base/budget.h"
#include "daemon/correction/ladder/knot_choice.h"
#include "daemon/correction/ladder/part_drawer.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr double kMostGrowth = 1.06;            // of the cost, for fewer knots
constexpr double kBeside = 0.5;                 // of the length of a part: how far it may extend
constexpr std::size_t kMostKnotsRelaxed = 100;  // of a dear part: steps take as much longer
constexpr double kDear_rad = 0.3;               // cost of a part, divided by its duration
constexpr int kStepsOfRelaxation = 8;           // of the first
constexpr int kStepsOfRoom = 12;                // of the relaxation that makes room

class Redrawer {
 public:
  /// Refers to all arguments, which must outlive it. `changed`: the part that is drawn again.
  /// `part`: where rows may change the path. `path`: the corrected path.
  Redrawer(const Problem& problem, const ChangedPart& changed, const ChangedPart& part,
           const CubicPath& path, FreeSpace& space, const base::Deadline& deadline)
      : part_(part),
        path_(path),
        drawer_(problem, changed, part, Objective::kClosest, space, space, deadline) {}

  /// Returns the part drawn again; nothing if it is not worth it.
  std::optional<Candidate> run() {
    std::optional<Drawing> best = drawer_.drawing(drawer_.choice().knots_of(path_), path_);
    if (!best) return std::nullopt;
    extend(*best);
    drawer_.limit_cost(kMostGrowth * std::min(best->cost, drawer_.cost(path_)));
    drawer_.cut_at_keyframes(*best);
    drawer_.thin_out(*best);
    if (!drawer_.is_worth(*best)) return std::nullopt;
    make_room(*best);
    return std::move(best->drawn.candidate);
  }

 private:
  /// Lets the part become longer, where that is cheaper. A dear part that is as long as it may be,
  /// such as a way round, is only relaxed.
  void extend(Drawing& best) const {
    const KnotChoice& choice = drawer_.choice();
    base::Budget budget(kStepsOfRelaxation);
    std::vector<double> knots_s = choice.extended(best.knots_s, part_.begin_s, part_.end_s);
    if (knots_s.size() == best.knots_s.size()) {
      const bool is_dear = best.cost > kDear_rad * (part_.end_s - part_.begin_s);
      if (is_dear && knots_s.size() <= kMostKnotsRelaxed)
        drawer_.relax(best, /*makes_room=*/false, budget);
      return;
    }
    std::optional<Drawing> longer = drawer_.drawing(std::move(knots_s), best.drawn.candidate.path);
    if (!longer) return;
    drawer_.relax(*longer, /*makes_room=*/false, budget);
    if (longer->cost >= best.cost) return;
    best = *std::move(longer);
    best.knots_s = choice.trimmed(best.knots_s, best.drawn.candidate.path);
  }

  /// Moves the part away from what it passes. This is the last step, because a drawing on other
  /// knots would not keep the room.
  void make_room(Drawing& best) const {
    base::Budget budget(kStepsOfRoom);
    drawer_.relax(best, /*makes_room=*/true, budget);
  }

  const ChangedPart& part_;
  const CubicPath& path_;
  PartDrawer drawer_;
};

}  // namespace

void redraw(const std::vector<ChangedPart>& parts, const motion::TimeOrigin& origin,
            FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions) {
  for (const ChangedPart& part : parts) {
    if (corrected.deadline().passed()) return;
    const ChangedPart wide = corrected.widened(part, kBeside);
    Problem problem =
        collisions.with_open_collisions(corrected.restored(wide, origin, space.ball_radius_m()));
    // The new row may begin later or end sooner than the part that it replaces.
    problem.interval = {part.begin_s, part.end_s};
    const CubicPath path = corrected.path().around(problem.path.begin_s(), problem.path.end_s());
    const std::optional<Candidate> drawn =
        Redrawer(problem, part, wide, path, space, corrected.deadline()).run();
    if (drawn && corrected.take_instead(part, *drawn)) {
      collisions.set_range(part, corrected.range_of(*drawn));
    }
  }
}

}  // namespace camway::correction
