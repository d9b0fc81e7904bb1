// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/redraw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/base/budget.h"
#include "daemon/correction/ladder/knot_choice.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/fit.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr double kMostGrowth = 1.25;     // of the cost, for fewer knots
constexpr double kKeptRoom = 0.57;       // of the least gap of the part, up to what is wanted
constexpr double kRoomResolution = 0.1;  // share of the gap that is kept: resolution of its check
constexpr double kLessRoom = 0.75;       // from one attempt to find a gap that is kept to the next
constexpr int kRoomAttempts = 6;
constexpr int kSamplesAPiece = 6;  // of the gap
// Steps of the first and of the last relaxation, and of all between.
constexpr int kStepsOfRelaxation = 12;
constexpr std::size_t kMostKnots = 128;  // of a part: relaxation takes cubic time
constexpr std::array<std::size_t, 8> kCounts = {5, 6, 7, 8, 10, 12, 16, 20};  // of knots
/// Factors of the offsets that are tried: fewer knots round the path off, into what it goes round.
constexpr std::array<double, 2> kScales = {1.0, 1.15};

/// A changed part, drawn as one row of bumps on `knots_s`.
struct Drawing {
  std::vector<double> knots_s;
  Relaxed drawn;
  double cost = 0.0;
};

class Redrawer {
 public:
  /// Refers to all arguments, which must outlive it. `path`: the corrected path.
  Redrawer(const Problem& problem, const ChangedPart& part, const CubicPath& path, FreeSpace& space,
           const base::Deadline& deadline)
      : problem_(problem),
        part_(part),
        path_(path),
        space_(space),
        deadline_(deadline),
        choice_(problem, part) {}

  /// Returns the part drawn again; nothing if it is not worth it.
  std::optional<Candidate> run() {
    std::optional<Drawing> best = drawing(choice_.joints_of(path_), path_);
    if (!best) return std::nullopt;
    // A correction was relaxed by itself.
    if (part_.corrections > 1) relax(*best, kStepsOfRelaxation);
    most_cost_ = kMostGrowth * std::min(best->cost, cost(path_));
    const std::size_t most_knots = best->knots_s.size();
    keep_room_of(best->drawn.candidate.path);
    place_anew(*best);
    thin_out(*best);
    if (best->knots_s.size() < most_knots) {
      Drawing last = *best;
      relax(last, kStepsOfRelaxation);
      if (is_worth(last)) best = std::move(last);
    } else if (!is_worth(*best)) {
      return std::nullopt;
    }
    return std::move(best->drawn.candidate);
  }

 private:
  /// The cost of the part alone.
  [[nodiscard]] double cost(const CubicPath& path) const {
    return closeness_cost(path.around(part_.begin_s, part_.end_s), problem_.original,
                          space_.closeness());
  }

  /// The least gap of samples of the part, at most `up_to_m`.
  [[nodiscard]] double room_m(const CubicPath& path, double up_to_m) const {
    double least_m = up_to_m;
    for (const motion::CubicPiece& piece : path.around(part_.begin_s, part_.end_s).pieces) {
      for (int i = 0; i < kSamplesAPiece && least_m > 0.0; ++i) {
        const double time_s = std::lerp(piece.t0_s, piece.t1_s, (i + 0.5) / kSamplesAPiece);
        least_m = std::min(least_m, space_.gap_m(path.pose(time_s), least_m));
      }
    }
    return least_m;
  }

  /// Makes drawings keep a share of the least gap of the part, as far as that gap is wanted.
  void keep_room_of(const CubicPath& path) {
    const double wanted_m = ContactBounds(Objective::kClosest, space_.ball_radius_m(),
                                          space_.closeness().viewing_distance_m)
                                .wanted_m();
    double gap_m = kKeptRoom * room_m(path, wanted_m);
    for (int i = 0; i < kRoomAttempts && gap_m > 0.0 && !deadline_.passed(); ++i) {
      keep(gap_m);
      if (keeps_room(path)) return;
      gap_m *= kLessRoom;  // between the samples there is less
    }
    roomy_.reset();
  }

  void keep(double gap_m) {
    collision::Query query = space_.query();
    collision::DetectOptions& options = query.options;
    options.clearance_m += gap_m;
    // The required clearance does not apply to the bounds.
    query.obstacles.bounds = query.obstacles.bounds.shrunk_by(gap_m);
    options.tolerance_m = std::max(options.tolerance_m, kRoomResolution * gap_m);
    options.joining_distance_m = std::max(options.joining_distance_m, options.tolerance_m);
    roomy_.emplace(query, space_.policy(), space_.closeness());
  }

  [[nodiscard]] bool keeps_room(const CubicPath& path) const {
    return !roomy_ ||
           !new_collision(path, part_.begin_s, part_.end_s, problem_, *roomy_, deadline_);
  }

  /// Whether the part is free where the row does not reach: there it is as interpolated again.
  [[nodiscard]] bool is_free_beside(const Candidate& candidate) const {
    double begin_s = part_.end_s;
    double end_s = part_.begin_s;
    for (const motion::BumpRow& row : candidate.rows) {
      begin_s = std::clamp(row.begin_s(), part_.begin_s, begin_s);
      end_s = std::clamp(row.end_s(), end_s, part_.end_s);
    }
    const auto is_free = [&](double from_s, double to_s) {
      return !(from_s < to_s) ||
             !new_collision(candidate.path, from_s, to_s, problem_, space_, deadline_);
    };
    return is_free(part_.begin_s, begin_s) && is_free(end_s, part_.end_s);
  }

  [[nodiscard]] bool is_worth(const Drawing& drawing) const {
    return drawing.cost <= most_cost_ && is_free_beside(drawing.drawn.candidate) &&
           keeps_room(drawing.drawn.candidate.path);
  }

  /// The drawing on `knots_s` that is nearest to `wanted`; nothing if it collides.
  [[nodiscard]] std::optional<Drawing> drawing(std::vector<double> knots_s,
                                               const CubicPath& wanted) const {
    if (!choice_.is_valid(knots_s) || knots_s.size() > kMostKnots) return std::nullopt;
    const motion::KnotRow knots = motion::KnotRow::at(knots_s, problem_.places);
    const FreeCoefficients free(problem_, knots, Ends::kFixed);
    if (!knots.fits() || free.size() == 0) return std::nullopt;
    const Offsets nearest = fitted(free, wanted, problem_.path);
    for (const double scale : kScales) {
      Offsets offsets = nearest;
      for (motion::CubicPoint& offset : offsets.at) {
        offset.position *= scale;
        // Where nothing turns, what the fit finds is rounding.
        offset.image *= part_.turns ? scale : 0.0;
      }
      std::optional<Candidate> found =
          free_candidate(problem_, {bumps_for(offsets, Ends::kFixed)}, space_, deadline_);
      if (!found || !is_free_beside(*found)) continue;
      const double drawn_cost = cost(found->path);
      return Drawing{std::move(knots_s), {std::move(offsets), *std::move(found)}, drawn_cost};
    }
    return std::nullopt;
  }

  void relax(Drawing& drawing, int steps) const {
    base::Budget budget(steps);
    relax(drawing, budget);
  }
  void relax(Drawing& drawing, base::Budget& budget) const {
    drawing.drawn = relaxed(problem_, std::move(drawing.drawn), Ends::kFixed,
                            {.may_turn = part_.turns}, budget, space_, deadline_);
    drawing.cost = cost(drawing.drawn.candidate.path);
  }

  /// Draws `best` on other knots; returns false if that is not worth it.
  bool redraw_on(std::vector<double> knots_s, Drawing& best) {
    std::optional<Drawing> sparser = drawing(std::move(knots_s), best.drawn.candidate.path);
    if (!sparser) return false;
    if (!is_worth(*sparser)) relax(*sparser, budget_);
    if (!is_worth(*sparser)) return false;
    best = *std::move(sparser);
    return true;
  }

  /// Draws on as few knots as possible, placed anew.
  void place_anew(Drawing& best) {
    for (const std::size_t count : kCounts) {
      std::vector<double> knots_s = choice_.spaced(best.knots_s, best.drawn.candidate.path, count);
      if (deadline_.passed()) return;
      if (knots_s.size() >= best.knots_s.size()) continue;
      if (redraw_on(std::move(knots_s), best)) return;
    }
  }

  /// Removes knots in batches, halved where that is too much at once.
  void thin_out(Drawing& best) {
    const auto removable = [&] {
      return choice_.removable(best.knots_s, best.drawn.candidate.path);
    };
    std::vector<std::size_t> knots = removable();
    std::size_t batch = (knots.size() + 1) / 2;
    while (batch > 0 && !deadline_.passed()) {
      knots.resize(batch);
      std::ranges::sort(knots);
      std::vector<double> left_s = best.knots_s;
      for (std::size_t i = batch; i-- > 0;) {
        left_s.erase(left_s.begin() + static_cast<std::ptrdiff_t>(knots[i]));
      }
      const bool is_less = redraw_on(std::move(left_s), best);
      if (!is_less) batch /= 2;
      knots = removable();
      batch = std::min(batch, is_less ? (knots.size() + 1) / 2 : knots.size());
    }
  }

  const Problem& problem_;
  const ChangedPart& part_;
  const CubicPath& path_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  const KnotChoice choice_;
  base::Budget budget_{kStepsOfRelaxation};
  std::optional<FreeSpace> roomy_;  ///< requires the gap that drawings keep
  double most_cost_ = 0.0;
};

}  // namespace

void redraw(const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
            CollisionList& collisions) {
  const std::vector<ChangedPart> parts = corrected.changed_parts();
  for (const ChangedPart& part : parts) {
    if (corrected.deadline().passed()) return;
    const Problem problem =
        collisions.with_open_collisions(corrected.restored(part, origin, space.ball_radius_m()));
    const CubicPath path = corrected.path().around(problem.path.begin_s(), problem.path.end_s());
    const std::optional<Candidate> drawn =
        Redrawer(problem, part, path, space, corrected.deadline()).run();
    if (drawn && corrected.take_instead(part, *drawn)) {
      collisions.set_range(part, corrected.range_of(*drawn));
    }
  }
}

}  // namespace camway::correction
