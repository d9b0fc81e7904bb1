// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/smoothing_form.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "daemon/motion/path/bezier.h"

namespace camway::correction {

namespace {

using motion::CubicPoint;
using motion::KnotBump;

constexpr double kRoundedShare = 0.01;  // of the largest offset: δ
constexpr double kSwerve = 0.2;     // spread for `kSafest`, by a weight that outweighs distances
constexpr double kRounding = 0.03;  // share of the interval: how wide `kShortest` rounds a corner

/// Places of Gauss's rule with two points on [0, 1], whose weights are equal.
constexpr std::array<double, 2> kGaussPair = {0.21132486540518712, 0.7886751345948129};
/// Places and weights of Gauss's rule with four points on [0, 1].
constexpr std::array<std::pair<double, double>, 4> kGauss = {
    {{0.06943184420297371, 0.17392742256872692},
     {0.33000947820757187, 0.32607257743127307},
     {0.6699905217924281, 0.32607257743127307},
     {0.9305681557970263, 0.17392742256872692}}};

/// The path, extended beyond its ends along its tangents: natural end conditions.
CubicPoint extended(const motion::CubicPath& path, double time_s) {
  const bool is_before = time_s < path.begin_s();
  if (!is_before && time_s <= path.end_s()) return path.at(time_s);
  const motion::CubicPiece& piece = is_before ? path.pieces.front() : path.pieces.back();
  const std::size_t i = is_before ? 0 : 2;  // the leg of the control polygon at that end
  const double legs =
      3.0 / (piece.t1_s - piece.t0_s) * (time_s - (is_before ? piece.t0_s : piece.t1_s));
  const std::size_t end = is_before ? 0 : 3;
  return {piece.position[end] + legs * (piece.position[i + 1] - piece.position[i]),
          piece.image[end] + legs * (piece.image[i + 1] - piece.image[i])};
}

CubicPoint difference(const CubicPoint& a, const CubicPoint& b) {
  return {a.position - b.position, a.image - b.image};
}

/// Times between a knot of a row or of the path, and the next.
struct Step {
  double begin_s;
  double end_s;
  int knot;                         ///< the last knot up to `begin_s`
  const motion::CubicPiece& piece;  ///< of the path
};

/// Calls `use` with each step of the path that bumps reach.
template <class Use>
void for_each_step(const motion::CubicPath& path, const FreeCoefficients& free, const Use& use) {
  const motion::KnotRow& knots = free.knots();
  std::size_t first = 0;
  for (int k = free.first() - kBumpReach; k < free.last() + kBumpReach; ++k) {
    const double begin_s = std::max(knots.knot_s(k), path.begin_s());
    const double end_s = std::min(knots.knot_s(k + 1), path.end_s());
    if (!(begin_s < end_s)) continue;
    while (path.pieces[first].t1_s <= begin_s) ++first;
    for (std::size_t i = first; i < path.pieces.size() && path.pieces[i].t0_s < end_s; ++i) {
      const motion::CubicPiece& piece = path.pieces[i];
      use(Step{std::max(begin_s, piece.t0_s), std::min(end_s, piece.t1_s), k, piece});
    }
  }
}

/// The position of the eye and its derivatives by time.
motion::bezier::Jet<geometry::Vec3> eye_at(const motion::CubicPiece& piece, double time_s) {
  const double duration_s = piece.t1_s - piece.t0_s;
  auto jet = motion::bezier::jet_at(piece.position, (time_s - piece.t0_s) / duration_s);
  jet.first /= duration_s;
  jet.second /= duration_s * duration_s;
  return jet;
}

StackedPoint moved_by(const geometry::Vec3& move) {
  return stacked({move, geometry::Vec4::Zero()}, 1.0);
}

/// The value or a derivative of the row of bumps at a time between the knots `knot` and `knot + 1`.
Terms sum_of_bumps(int knot, const FreeCoefficients& free,
                   double (KnotBump::*derivative)(double) const, double time_s) {
  Terms terms;
  const int last = std::min(knot + kBumpReach, free.last());
  for (int k = std::max(knot - kBumpReach + 1, free.first()); k <= last; ++k) {
    free.add(k, (free.bump(k).*derivative)(time_s), terms);
  }
  return terms;
}

}  // namespace

SmoothingForm::SmoothingForm(const Problem& problem, const FreeCoefficients& free,
                             Objective objective, double lever_m, const Closeness& closeness,
                             const StackedPoints& about)
    : bending_(free.size()), squares_(free.size()) {
  const double a = closeness.acceleration_m_per_s2;
  switch (objective) {
    case Objective::kClosest:
      find_places(problem, free, lever_m,
                  2.0 * kAccelerationWeight_rad * closeness.viewing_distance_m / (a * a));
      bound_about(about);
      break;
    case Objective::kShortest:
      find_velocities(problem, free, lever_m);
      bound_about(about);
      break;
    case Objective::kSmoothest:
      count_bending(problem, free, 1.0);
      squares_ = bending_;
      solve();
      break;
    case Objective::kSafest:
      count_differences(problem, free, lever_m);
      solve();
      break;
  }
}

// Between two knots of the row the bumps are cubic, and so is the offset where the path has no knot
// there.
// Gauss's rule with four points is exact for the squares of both.
void SmoothingForm::find_places(const Problem& problem, const FreeCoefficients& free,
                                double lever_m, double bend_weight) {
  const motion::KnotRow& knots = free.knots();
  for (int k = free.first() - kBumpReach; k < free.last() + kBumpReach; ++k) {
    const double begin_s = std::max(knots.knot_s(k), problem.path.begin_s());
    const double end_s = std::min(knots.knot_s(k + 1), problem.path.end_s());
    if (!(begin_s < end_s)) continue;
    for (const auto& [share, weight] : kGauss) {
      const double time_s = std::lerp(begin_s, end_s, share);
      Place& place = places_.emplace_back();
      place.share_s = weight * (end_s - begin_s);
      place.value = sum_of_bumps(k, free, &KnotBump::value, time_s);
      const Terms bent = sum_of_bumps(k, free, &KnotBump::second_derivative, time_s);
      place.constant =
          stacked(difference(problem.path.at(time_s), problem.original.at(time_s)), lever_m);
      bending_.count(place.share_s * bend_weight, bent,
                     stacked(difference(problem.path.second_derivative(time_s),
                                        problem.original.second_derivative(time_s)),
                             lever_m));
    }
  }
}

void SmoothingForm::bound_about(const StackedPoints& about) {
  assert(!places_.empty());
  if (bound_at_ && *bound_at_ == about) return;  // the form would be the same
  bound_at_ = about;
  std::vector<double> sizes_m;
  for (const Place& place : places_) {
    sizes_m.push_back((place.constant + combined(place.value, about)).norm());
  }
  const double largest_m = sizes_m.empty() ? 0.0 : *std::ranges::max_element(sizes_m);
  const double floor_m = largest_m > 0.0 ? kRoundedShare * largest_m : 1.0;
  squares_ = bending_;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    squares_.count(place.share_s / std::hypot(sizes_m[i], floor_m), place.value, place.constant);
  }
  solve();
}

double SmoothingForm::bounded_value(const StackedPoints& variables) const {
  if (places_.empty()) return value(variables);
  double sum = bending_.value(variables);
  for (const Place& place : places_) {
    sum += 0.5 * place.share_s * (place.constant + combined(place.value, variables)).norm();
  }
  return sum;
}

void SmoothingForm::solve() {
  factors_.emplace(squares_.hessian);
  minimum_ = -squares_.slope;
  factors_->solve_in_place(minimum_);
}

// A corner that is rounded off over the share r of an interval of duration T, at the mean speed v,
// has the weight λ = (r·T)²/v.
void SmoothingForm::find_velocities(const Problem& problem, const FreeCoefficients& free,
                                    double lever_m) {
  double length_m = 0.0;
  double duration_s = 0.0;
  for_each_step(problem.path, free, [&](const Step& step) {
    for (const auto& [share, weight] : kGauss) {
      const double time_s = std::lerp(step.begin_s, step.end_s, share);
      const double share_s = weight * (step.end_s - step.begin_s);
      const geometry::Vec3 velocity = eye_at(step.piece, time_s).first;
      length_m += share_s * velocity.norm();
      duration_s += share_s;
      places_.push_back({share_s,
                         sum_of_bumps(step.knot, free, &KnotBump::first_derivative, time_s),
                         moved_by(velocity)});
    }
  });
  const double rounded_s = kRounding * (problem.leg_end_s() - problem.leg_begin_s());
  // If the camera only turns, corrections move it by about its own size.
  const double speed_m_per_s = std::max(length_m, lever_m) / duration_s;
  count_bending(problem, free, rounded_s * rounded_s / speed_m_per_s);
}

// The second derivative is linear on each step, so the integral of its square is exact.
void SmoothingForm::count_bending(const Problem& problem, const FreeCoefficients& free,
                                  double weight) {
  for_each_step(problem.path, free, [&](const Step& step) {
    for (const double share : kGaussPair) {
      const double time_s = std::lerp(step.begin_s, step.end_s, share);
      bending_.count(0.5 * weight * (step.end_s - step.begin_s),
                     sum_of_bumps(step.knot, free, &KnotBump::second_derivative, time_s),
                     moved_by(eye_at(step.piece, time_s).second));
    }
  });
}

void SmoothingForm::count_differences(const Problem& problem, const FreeCoefficients& free,
                                      double lever_m) {
  const double bend_weight = std::pow(kSwerve * free.knots().count, 4.0);
  const auto path_at = [&](int k) {
    return stacked(extended(problem.path, free.knots().knot_s(k)), lever_m);
  };
  for (int k = free.first() - 2; k <= free.last() + 2; ++k) {
    const double time_s = free.knots().knot_s(k);
    if (time_s < problem.path.begin_s() || time_s > problem.path.end_s()) continue;
    const StackedPoint here = path_at(k);
    Terms value;
    free.add(k, 1.0, value);
    squares_.count(1.0, value, here - stacked(extended(problem.original, time_s), lever_m));
    Terms bend;
    free.add(k - 1, 1.0, bend);
    free.add(k, -2.0, bend);
    free.add(k + 1, 1.0, bend);
    squares_.count(bend_weight, bend, path_at(k - 1) - 2.0 * here + path_at(k + 1));
  }
}

}  // namespace camway::correction
