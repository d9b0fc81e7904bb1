// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/part_drawer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "daemon/correction/smoothing/fit.h"
#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr int kStepsOfDrawings = 8;      // for all drawings on other knots
constexpr std::size_t kMostKnots = 400;  // of a part
constexpr std::size_t kMostNeeded = 16;  // knots without which a part is found to collide
/// Factors of the offsets that are tried: fewer knots round the path off, into what it goes round.
constexpr std::array<double, 2> kScales = {1.0, 1.15};

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

}  // namespace

PartDrawer::PartDrawer(const Problem& problem, const ChangedPart& changed, const ChangedPart& part,
                       Objective objective, FreeSpace& space, FreeSpace& measured,
                       const base::Deadline& deadline)
    : problem_(problem),
      part_(part),
      objective_(objective),
      space_(space),
      measured_(measured),
      deadline_(deadline),
      choice_(problem, changed),
      budget_(kStepsOfDrawings) {}

double PartDrawer::cost(const CubicPath& path) const {
  return objective_value(objective_, path.around(part_.begin_s, part_.end_s), problem_.original,
                         measured_);
}

std::optional<Drawing> PartDrawer::drawing(std::vector<double> knots_s,
                                           const CubicPath& wanted) const {
  return try_drawing(std::move(knots_s), wanted).drawing;
}

PartDrawer::Tried PartDrawer::try_drawing(std::vector<double> knots_s,
                                          const CubicPath& wanted) const {
  if (!choice_.is_valid(knots_s) || knots_s.size() > kMostKnots) return {};
  const motion::KnotRow knots = motion::KnotRow::at(knots_s, problem_.places);
  const FreeCoefficients free(problem_, knots, Ends::kFixed);
  if (!knots.fits() || free.size() == 0) return {};
  const Offsets nearest = fitted(free, wanted, problem_.path);
  Tried tried;
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

void PartDrawer::relax(Drawing& drawing, bool makes_room, base::Budget& budget) const {
  const bool may_turn = part_.turns && objective_ == Objective::kClosest;
  const Improvement improvement{
      .objective = objective_, .may_turn = may_turn, .makes_room = makes_room};
  drawing.drawn = relaxed(problem_, std::move(drawing.drawn), Ends::kFixed, improvement, budget,
                          space_, deadline_);
  drawing.cost = cost(drawing.drawn.candidate.path);
}

/// Draws `best` on other knots, if that is worth it.
PartDrawer::Redrawn PartDrawer::redraw_on(std::vector<double> knots_s, Drawing& best) {
  Tried tried = try_drawing(std::move(knots_s), best.drawn.candidate.path);
  if (!tried.drawing) return {false, tried.collides_s};
  if (!is_worth(*tried.drawing)) relax(*tried.drawing, /*makes_room=*/false, budget_);
  if (!is_worth(*tried.drawing)) return {};
  best = *std::move(tried.drawing);
  return {.is_taken = true};
}

void PartDrawer::cut_at_keyframes(Drawing& best) {
  std::vector<double> knots_s = choice_.cut_at_keyframes(best.knots_s, best.drawn.candidate.path);
  if (knots_s != best.knots_s) redraw_on(std::move(knots_s), best);
}

void PartDrawer::thin_out(Drawing& best) {
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
std::vector<double> PartDrawer::spared(const Drawing& best,
                                       const std::vector<double>& needed_s) const {
  std::vector<double> knots_s;
  for (const std::size_t i : choice_.removable(best.knots_s, best.drawn.candidate.path)) {
    const double knot_s = best.knots_s[i];
    if (std::ranges::find(needed_s, knot_s) == needed_s.end()) knots_s.push_back(knot_s);
  }
  return knots_s;
}

}  // namespace camway::correction
