// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/follow_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved.
constexpr std::array<int, 4> kCoarse = {8, 12, 16, 32};  // numbers of knots
constexpr std::array<int, 4> kFine = {8, 16, 32, 64};
constexpr int kMostRefinements = 40;  // finer rows of bumps
constexpr int kFinest = 2048;
constexpr std::array<double, 2> kMargins = {0.25, 0.02};  // shares of the ball's radius
constexpr double kLongestStep = 3.0;  // between poses of a guide, in radii of the ball

/// The largest number of knots of the rows that reach a time.
int finest_at(const std::vector<motion::BumpRow>& rows, double time_s) {
  int finest = kFine.back();
  for (const motion::BumpRow& row : rows) {
    if (row.begin_s() < time_s && time_s < row.end_s()) finest = std::max(finest, row.knots.count);
  }
  return finest;
}

/// The offsets about a time range, as bumps.
motion::BumpRow part_of(const Offsets& offsets, const collision::CollisionInterval& about) {
  const motion::KnotRow& knots = offsets.knots;
  const auto knot_before = [&](double time_s) {
    return static_cast<int>(std::floor((time_s - knots.begin_s) / knots.spacing_s()));
  };
  motion::BumpRow row{knots, std::max(2, knot_before(about.t_begin_s) - 2), {}};
  const int last = std::min(knots.count - 2, knot_before(about.t_end_s) + 3);
  for (int k = row.first; k <= last; ++k) row.bumps.push_back(offsets(k));
  return row;
}

class Follower {
 public:
  Follower(const Problem& problem, Turning turning, base::Budget& budget, FreeSpace& space,
           const base::Deadline& deadline)
      : problem_(problem), turning_(turning), budget_(budget), space_(space), deadline_(deadline) {}

  /// Follows the guide as it is, or else shortened.
  std::optional<Candidate> run(const Guide& guide) {
    if (guide.empty()) return std::nullopt;
    // A lattice guide keeps away from the scene; a shortened one turns around corners.
    for (const int count : kCoarse) {
      if (std::optional<Candidate> found = drawn(guide, count)) return found;
    }
    // `shortened` can then skip parts of long motions.
    const Guide fine = divided(guide, space_, kLongestStep * space_.ball_radius_m());
    for (const double margin : kMargins) {
      const Guide direct = shortened(fine, space_, margin * space_.ball_radius_m());
      for (const int count : kFine) {
        if (deadline_.passed()) return std::nullopt;
        if (std::optional<Candidate> found = drawn(direct, count)) return found;
      }
      if (std::optional<Candidate> found = refined(direct)) return found;
    }
    return std::nullopt;
  }

  [[nodiscard]] int paths() const { return paths_; }

 private:
  /// Draws the path to the guide by one row of bumps, and improves the result.
  std::optional<Candidate> drawn(const Guide& guide, int count) {
    const motion::KnotRow knots = problem_.knots(count);
    if (!knots.fits()) return std::nullopt;
    const TimedGuide timed(problem_.path, guide, knots.begin_s, knots.end_s, space_);
    const std::optional<Offsets> offsets = offsets_on(problem_.path, timed, knots);
    if (!offsets) return std::nullopt;
    for (const Ends ends : {Ends::kFree, Ends::kFixed}) {
      std::optional<Candidate> found = tried(*offsets, ends);
      if (found) return improved(*offsets, ends, std::move(*found));
    }
    return std::nullopt;
  }

  /// Draws the path to the guide by a coarse row of bumps, and adds finer ones only where that
  /// collides.
  std::optional<Candidate> refined(const Guide& guide) {
    motion::KnotRow knots = problem_.knots(kFine.back());
    if (!knots.fits()) return std::nullopt;
    const TimedGuide timed(problem_.path, guide, knots.begin_s, knots.end_s, space_);
    const std::optional<Offsets> offsets = offsets_on(problem_.path, timed, knots);
    if (!offsets) return std::nullopt;
    std::vector<motion::BumpRow> rows = {bumps_for(*offsets, Ends::kFixed)};
    for (int i = 0; i < kMostRefinements && !deadline_.passed(); ++i) {
      Attempt tried = attempt(problem_, rows, space_, deadline_);
      ++paths_;
      if (tried.candidate) return std::move(tried.candidate);
      const double at_s = 0.5 * (tried.collision->t_begin_s + tried.collision->t_end_s);
      knots.count = 2 * finest_at(rows, at_s);
      if (knots.count > kFinest || !knots.fits()) return std::nullopt;
      const std::optional<Offsets> rest =
          offsets_on(motion::with_bumps(problem_.path, rows), timed, knots);
      if (!rest) return std::nullopt;
      rows.push_back(part_of(*rest, *tried.collision));
      if (rows.back().bumps.empty()) return std::nullopt;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Offsets> offsets_on(const motion::CubicPath& path,
                                                  const TimedGuide& timed,
                                                  const motion::KnotRow& knots) const {
    return offsets_to(path, problem_.original, timed, knots, turning_, space_);
  }

  std::optional<Candidate> tried(const Offsets& offsets, Ends ends) {
    ++paths_;
    return free_candidate(problem_, {bumps_for(offsets, ends)}, space_, deadline_);
  }

  Candidate improved(const Offsets& offsets, Ends ends, Candidate found) {
    const Improvement improvement{.may_turn = turning_ == Turning::kAsGuide,
                                  .most_steps = kStepsOfChoice};
    Relaxed better = relaxed(problem_, {offsets, std::move(found)}, ends, improvement, budget_,
                             space_, deadline_);
    paths_ += better.paths;
    return std::move(better.candidate);
  }

  const Problem& problem_;
  const Turning turning_;
  base::Budget& budget_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  int paths_ = 0;  ///< changed paths that were checked for collisions
};

}  // namespace

Followed follow(const Problem& problem, const Guide& guide, Turning turning, base::Budget& budget,
                FreeSpace& space, const base::Deadline& deadline) {
  Follower follower(problem, turning, budget, space, deadline);
  Followed followed;
  followed.candidate = follower.run(guide);
  followed.paths = follower.paths();
  return followed;
}

}  // namespace camway::correction
