// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/redraw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/base/budget.h"
#include "daemon/correction/ladder/knot_choice.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/fit.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr double kMostGrowth = 1.06;            // of the cost, for fewer knots
constexpr double kBeside = 0.5;                 // of the length of a part: how far it may extend
constexpr std::size_t kMostKnotsRelaxed = 100;  // of a dear part: steps take as much longer
constexpr double kDear_rad = 0.3;               // cost of a part, divided by its duration
constexpr int kStepsOfRelaxation = 8;           // of the first, and of all that follow
constexpr int kStepsOfRoom = 12;                // of the relaxation that makes room
constexpr std::size_t kMostKnots = 400;         // of a part
constexpr std::size_t kMostNeeded = 16;         // knots without which a part is found to collide
/// Factors of the offsets that are tried: fewer knots round the path off, into what it goes round.
constexpr std::array<double, 2> kScales = {1.0, 1.15};

/// A changed part, drawn as one row of bumps on `knots_s`.
struct Drawing {
  std::vector<double> knots_s;
  Relaxed drawn;
  double cost = 0.0;
};

/// A drawing, or the time of a collision that prevents it, if there is one.
struct TriedDrawing {
  std::optional<Drawing> drawing;
  std::optional<double> collides_s;
};

/// Whether other knots were taken, or the time of a collision that prevents it, if there is one.
struct Redrawn {
  bool is_taken = false;
  std::optional<double> collides_s = {};
};

std::size_t half_of(std::size_t count) { return (count + 1) / 2; }

double nearest(const std::vector<double>& knots_s, double time_s) {
  return *std::ranges::min_element(knots_s, {},
                                   [time_s](double knot_s) { return std::abs(knot_s - time_s); });
}

std::vector<double> without(std::vector<double> knots_s, const std::vector<double>& removed_s) {
  std::erase_if(knots_s, [&](double knot_s) {
    return std::ranges::find(removed_s, knot_s) != removed_s.end();
  });
  return knots_s;
}

class Redrawer {
 public:
  /// Refers to all arguments, which must outlive it. `changed`: the part that is drawn again.
  /// `part`: where rows may change the path. `path`: the corrected path.
  Redrawer(const Problem& problem, const ChangedPart& changed, const ChangedPart& part,
           const CubicPath& path, FreeSpace& space, const base::Deadline& deadline)
      : problem_(problem),
        part_(part),
        path_(path),
        space_(space),
        deadline_(deadline),
        choice_(problem, changed) {}

  /// Returns the part drawn again; nothing if it is not worth it.
  std::optional<Candidate> run() {
    std::optional<Drawing> best = drawing(choice_.joints_of(path_), path_);
    if (!best) return std::nullopt;
    extend(*best);
    most_cost_ = kMostGrowth * std::min(best->cost, cost(path_));
    cut_at_keyframes(*best);
    thin_out(*best);
    if (!is_worth(*best)) return std::nullopt;
    make_room(*best);
    return std::move(best->drawn.candidate);
  }

 private:
  /// The cost of the part alone.
  [[nodiscard]] double cost(const CubicPath& path) const {
    return closeness_cost(path.around(part_.begin_s, part_.end_s), problem_.original,
                          space_.closeness());
  }

  [[nodiscard]] bool is_worth(const Drawing& drawing) const { return drawing.cost <= most_cost_; }

  /// The drawing on `knots_s` that is nearest to `wanted`; nothing if it collides.
  [[nodiscard]] std::optional<Drawing> drawing(std::vector<double> knots_s,
                                               const CubicPath& wanted) const {
    return try_drawing(std::move(knots_s), wanted).drawing;
  }

  [[nodiscard]] TriedDrawing try_drawing(std::vector<double> knots_s,
                                         const CubicPath& wanted) const {
    if (!choice_.is_valid(knots_s) || knots_s.size() > kMostKnots) return {};
    const motion::KnotRow knots = motion::KnotRow::at(knots_s, problem_.places);
    const FreeCoefficients free(problem_, knots, Ends::kFixed);
    if (!knots.fits() || free.size() == 0) return {};
    const Offsets nearest = fitted(free, wanted, problem_.path);
    TriedDrawing tried;
    for (const double scale : kScales) {
      Offsets offsets = nearest;
      for (motion::CubicPoint& offset : offsets.at) {
        offset.position *= scale;
        // Where nothing turns, what the fit finds is rounding.
        offset.image *= part_.turns ? scale : 0.0;
      }
      Attempt found = attempt(problem_, {bumps_for(offsets, Ends::kFixed)}, space_, deadline_);
      if (found.candidate) {
        const double drawn_cost = cost(found.candidate->path);
        Relaxed drawn{std::move(offsets), *std::move(found.candidate)};
        return {Drawing{std::move(knots_s), std::move(drawn), drawn_cost}, std::nullopt};
      }
      tried.collides_s = std::midpoint(found.collision->t_begin_s, found.collision->t_end_s);
    }
    return tried;
  }

  void relax(Drawing& drawing, const Improvement& improvement, base::Budget& budget) const {
    drawing.drawn = relaxed(problem_, std::move(drawing.drawn), Ends::kFixed, improvement, budget,
                            space_, deadline_);
    drawing.cost = cost(drawing.drawn.candidate.path);
  }

  /// Lets the part become longer, where that is cheaper. A dear part that is as long as it may be,
  /// such as a way round, is only relaxed.
  void extend(Drawing& best) const {
    base::Budget budget(kStepsOfRelaxation);
    std::vector<double> knots_s = choice_.extended(best.knots_s, part_.begin_s, part_.end_s);
    if (knots_s.size() == best.knots_s.size()) {
      const bool is_dear = best.cost > kDear_rad * (part_.end_s - part_.begin_s);
      if (is_dear && knots_s.size() <= kMostKnotsRelaxed)
        relax(best, {.may_turn = part_.turns}, budget);
      return;
    }
    std::optional<Drawing> longer = drawing(std::move(knots_s), best.drawn.candidate.path);
    if (!longer) return;
    relax(*longer, {.may_turn = part_.turns}, budget);
    if (longer->cost >= best.cost) return;
    best = *std::move(longer);
    best.knots_s = choice_.trimmed(best.knots_s, best.drawn.candidate.path);
  }

  /// Moves the part away from what it passes. This is the last step, because a drawing on other
  /// knots would not keep the room.
  void make_room(Drawing& best) const {
    base::Budget budget(kStepsOfRoom);
    relax(best, {.may_turn = part_.turns, .makes_room = true}, budget);
  }

  /// Draws `best` on other knots, if that is worth it.
  Redrawn redraw_on(std::vector<double> knots_s, Drawing& best) {
    TriedDrawing tried = try_drawing(std::move(knots_s), best.drawn.candidate.path);
    if (!tried.drawing) return {false, tried.collides_s};
    if (!is_worth(*tried.drawing)) relax(*tried.drawing, {.may_turn = part_.turns}, budget_);
    if (!is_worth(*tried.drawing)) return {};
    best = *std::move(tried.drawing);
    return {.is_taken = true};
  }

  /// Ends the part at keyframes that it crosses for little.
  void cut_at_keyframes(Drawing& best) {
    std::vector<double> knots_s = choice_.cut_at_keyframes(best.knots_s, best.drawn.candidate.path);
    if (knots_s != best.knots_s) redraw_on(std::move(knots_s), best);
  }

  /// Removes knots in batches, halved where that is too much at once. A knot without which the path
  /// collides stays.
  void thin_out(Drawing& best) {
    std::vector<double> needed_s;
    std::vector<double> knots_s = spared(best, needed_s);
    std::size_t batch = half_of(knots_s.size());
    while (batch > 0 && !deadline_.passed()) {
      knots_s.resize(batch);
      const Redrawn redrawn = redraw_on(without(best.knots_s, knots_s), best);
      const bool is_hit = redrawn.collides_s && needed_s.size() < kMostNeeded;
      if (is_hit) needed_s.push_back(nearest(knots_s, *redrawn.collides_s));
      knots_s = spared(best, needed_s);
      if (redrawn.is_taken)
        batch = half_of(knots_s.size());
      else
        batch = std::min(is_hit ? half_of(batch) : batch / 2, knots_s.size());
    }
  }

  /// The knots that may be removed, those that matter least first, without the ones that are
  /// needed.
  [[nodiscard]] std::vector<double> spared(const Drawing& best,
                                           const std::vector<double>& needed_s) const {
    std::vector<double> knots_s;
    for (const std::size_t i : choice_.removable(best.knots_s, best.drawn.candidate.path)) {
      const double knot_s = best.knots_s[i];
      if (std::ranges::find(needed_s, knot_s) == needed_s.end()) knots_s.push_back(knot_s);
    }
    return knots_s;
  }

  const Problem& problem_;
  const ChangedPart& part_;
  const CubicPath& path_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  const KnotChoice choice_;
  base::Budget budget_{kStepsOfRelaxation};
  double most_cost_ = 0.0;
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
