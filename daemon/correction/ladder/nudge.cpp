// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/nudge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "daemon/correction/ladder/nudge_search.h"
#include "daemon/correction/ladder/window.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using geometry::Vec4;
using motion::CubicPoint;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved. Where three rows collide, so do 99 of
// 100 further ones, larger or shorter, and a way round costs about as much.
constexpr double kMoreEachTime = 1.35;
constexpr int kMostAttempts = 3;
constexpr double kLeastPeak = 0.1;  // least share of a bump at the collision

class Nudger {
 public:
  Nudger(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
         NudgeKind kind, base::Budget& budget, FreeSpace& space, const base::Deadline& deadline)
      : problem_(problem),
        kind_(kind),
        budget_(budget),
        space_(space),
        deadline_(deadline),
        search_(problem, collisions, kind, space) {}

  NudgeResult run() {
    NudgeResult result;
    const std::vector<Nudge> nudges = search_.smallest();
    double least_cost = std::numeric_limits<double>::infinity();
    for (const Nudge& nudge : nudges) {
      if (deadline_.passed()) break;
      std::optional<Candidate> found = as_bumps(nudge);
      if (!found) continue;
      const double cost = closeness_cost(found->path, problem_.original, space_.closeness());
      if (cost < least_cost) {
        least_cost = cost;
        result.candidate = std::move(found);
      }
    }
    effort_.directions = search_.directions();
    result.effort = effort_;
    return result;
  }

 private:
  /// The nudge as a row of bumps, over as long a time as the change of the picture suggests.
  std::optional<Candidate> as_bumps(Nudge nudge) {
    // A bump that turns is as high as its angle times the lever by which turns count.
    const double lever_m = kind_ == NudgeKind::kMove ? 1.0 : space_.closeness().turn_lever_m;
    const double spacing_s = space_.closeness().best_spacing_s(nudge.amount * lever_m);
    collision::CollisionInterval about = problem_.interval;
    for (int i = 0; i < kMostAttempts; ++i) {
      const motion::KnotRow knots =
          window_about(problem_, about.t_begin_s, about.t_end_s, spacing_s);
      if (!knots.fits()) return std::nullopt;
      const std::optional<Offsets> offsets =
          row_of(FreeCoefficients(problem_, knots, Ends::kFixed), offset_of(nudge), about);
      if (!offsets) return std::nullopt;
      Attempt tried = attempt(problem_, {bumps_for(*offsets, Ends::kFixed)}, space_, deadline_);
      ++effort_.paths;
      if (tried.candidate) return improved(*offsets, std::move(*tried.candidate));
      const collision::CollisionInterval& left = *tried.collision;
      if (left.t_begin_s < about.t_end_s && left.t_end_s > about.t_begin_s) {
        nudge.amount *= kMoreEachTime;
        continue;
      }
      // The bump meets something beside the collision: lead the path round both.
      const bool is_near =
          left.t_end_s > about.t_begin_s - spacing_s && left.t_begin_s < about.t_end_s + spacing_s;
      if (!is_near) return std::nullopt;
      about.t_begin_s = std::min(about.t_begin_s, left.t_begin_s);
      about.t_end_s = std::max(about.t_end_s, left.t_end_s);
    }
    return std::nullopt;
  }

  Candidate improved(const Offsets& offsets, Candidate candidate) {
    const Improvement improvement{.may_turn = kind_ == NudgeKind::kTurn,
                                  .most_steps = kStepsOfChoice};
    Relaxed better = relaxed(problem_, {offsets, std::move(candidate)}, Ends::kFixed, improvement,
                             budget_, space_, deadline_);
    effort_.paths += better.paths;
    return std::move(better.candidate);
  }

  /// The offset by which the nudge changes the path at the middle of the collision.
  [[nodiscard]] CubicPoint offset_of(const Nudge& nudge) const {
    const SignedPose wanted = search_.nudged_middle(nudge);
    const CubicPoint old = problem_.path.at(search_.middle_s());
    CubicPoint offset{wanted.position - old.position, Vec4::Zero()};
    if (wanted.orientation != search_.middle_pose().orientation) {
      const Vec4 image = motion::image_of(problem_.path.reference, wanted.orientation, old.image);
      offset.image = image * old.image.norm() - old.image;
    }
    return offset;
  }

  /// The row whose value is about `offset` in the time of the collision; nothing if it cannot be.
  [[nodiscard]] std::optional<Offsets> row_of(const FreeCoefficients& free,
                                              const CubicPoint& offset,
                                              const collision::CollisionInterval& about) const {
    // Least squares at the collision; the small term decides where bumps do not reach it.
    constexpr double kSmall = 1e-3;
    Eigen::MatrixXd squares = Eigen::MatrixXd::Identity(free.size(), free.size()) * kSmall;
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(free.size());
    for (const double place : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Terms terms = free.at(std::lerp(about.t_begin_s, about.t_end_s, place));
      for (const Term& a : terms) {
        wanted[a.variable] += a.share;
        for (const Term& b : terms) squares(a.variable, b.variable) += a.share * b.share;
      }
    }
    Eigen::VectorXd shares = squares.ldlt().solve(wanted);
    double peak = 0.0;
    for (const Term& term : free.at(search_.middle_s())) peak += term.share * shares[term.variable];
    if (!(peak > kLeastPeak)) return std::nullopt;
    shares /= peak;
    const StackedPoints variables = shares * stacked(offset, 1.0).transpose();
    return free.offsets_of(variables, 1.0);
  }

  const Problem& problem_;
  const NudgeKind kind_;
  base::Budget& budget_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  NudgeSearch search_;
  Effort effort_;
};

}  // namespace

NudgeResult nudge(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
                  NudgeKind kind, base::Budget& budget, FreeSpace& space,
                  const base::Deadline& deadline) {
  return Nudger(problem, collisions, kind, budget, space, deadline).run();
}

}  // namespace camway::correction
