// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/smoothing_form.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace camway::correction {

namespace {

using motion::CubicPoint;

constexpr int kBumpReach = 2;      // knots from a bump's peak to the end of its support
constexpr double kSwerve = 0.2;    // spread for `kSafest`, by a weight that outweighs distances
constexpr double kRounding = 0.1;  // share of the interval: how wide `kShortest` rounds a corner

/// Weights of the squared distance from the original, and of squared first and second differences
/// of the path's control points.
struct Weights {
  double distance;
  double stretch;
  double bend;
};

Weights weights_of(Objective objective, int count, double spread) {
  switch (objective) {
    case Objective::kClosest:
      return {1.0, 0.0, std::pow(spread * count, 4.0)};
    case Objective::kSafest:
      return {1.0, 0.0, std::pow(kSwerve * count, 4.0)};
    case Objective::kShortest:
      return {0.0, 1.0, std::pow(kRounding * count, 2.0)};
    case Objective::kSmoothest:
      return {0.0, 0.0, 1.0};
  }
  return {1.0, 0.0, 1.0};
}

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

/// Number of knots beyond a keyframe, to one side, at which a bump may have its peak without
/// reaching the next keyframe; 0 also where not even a bump at the keyframe itself stays clear of
/// it.
int knots_beyond(const motion::KnotRow& knots, int keyframe, int side, double next_s) {
  const auto reaches = [&](int beyond) {
    const double end_s = knots.knot_s(keyframe + side * (beyond + kBumpReach));
    return side < 0 ? end_s < next_s : end_s > next_s;
  };
  int beyond = 0;
  while (beyond < knots.count / 2 && !reaches(beyond + 1)) ++beyond;
  return beyond;
}

}  // namespace

bool fits_free_ends(const Problem& problem, const motion::KnotRow& knots) {
  const std::size_t leg = problem.leg;
  const std::vector<double>& times_s = problem.keyframes_s;
  return (leg == 0 || knots.knot_s(-kBumpReach) >= times_s[leg - 1]) &&
         (leg + 2 == times_s.size() || knots.knot_s(knots.count + kBumpReach) <= times_s[leg + 2]);
}

FreeCoefficients::FreeCoefficients(const Problem& problem, const motion::KnotRow& knots, Ends ends)
    : knots_(knots), first_(2), last_(knots.count - 2), holds_keyframes_(ends == Ends::kFree) {
  if (holds_keyframes_) {
    const std::size_t leg = problem.leg;
    const std::vector<double>& times_s = problem.keyframes_s;
    const bool is_last = leg + 2 == times_s.size();
    first_ = leg == 0 ? -1 : -knots_beyond(knots, 0, -1, times_s[leg - 1]);
    last_ = knots.count + (is_last ? 1 : knots_beyond(knots, knots.count, 1, times_s[leg + 2]));
  }
  for (int k = first_; k <= last_; ++k) size_ += is_held(k) ? 0 : 1;
  for (const int k : {0, knots.count}) {
    const double peak = knots.bump_at_knot(k, k);
    held_shares_[k == 0 ? 0 : 1] = {-knots.bump_at_knot(k - 1, k) / peak,
                                    -knots.bump_at_knot(k + 1, k) / peak};
  }
}

Eigen::Index FreeCoefficients::variable(int k) const {
  const int held_before =
      holds_keyframes_ ? (k > 0 && first_ <= 0 ? 1 : 0) + (k > knots_.count ? 1 : 0) : 0;
  return k - first_ - held_before;
}

void FreeCoefficients::add(int k, double factor, Terms& terms) const {
  if (k < first_ || k > last_ || factor == 0.0) return;
  if (is_held(k)) {
    const auto [of_before, of_after] = held_shares_[k == 0 ? 0 : 1];
    add(k - 1, factor * of_before, terms);
    add(k + 1, factor * of_after, terms);
    return;
  }
  const auto known = std::ranges::find(terms, variable(k), &Term::variable);
  if (known != terms.end()) {
    known->share += factor;
  } else {
    terms.push_back({variable(k), factor});
  }
}

Terms FreeCoefficients::at(double time_s) const {
  const double place = (time_s - knots_.begin_s) / knots_.spacing_s();
  const int before = static_cast<int>(std::clamp(std::floor(place), first_ - 2.0, last_ + 1.0));
  Terms terms;
  for (int k = before - 1; k <= before + 2; ++k) add(k, motion::bump_value(place - k), terms);
  return terms;
}

StackedPoints FreeCoefficients::variables_of(const Offsets& offsets, double lever_m) const {
  StackedPoints variables(size_, 7);
  for (int k = first_; k <= last_; ++k) {
    if (!is_held(k)) variables.row(variable(k)) = stacked(offsets(k), lever_m).transpose();
  }
  return variables;
}

Offsets FreeCoefficients::offsets_of(const StackedPoints& variables, double lever_m) const {
  Offsets offsets{knots_, first_, {}};
  for (int k = first_; k <= last_; ++k) {
    Terms terms;
    add(k, 1.0, terms);
    offsets.at.push_back(unstacked(combined(terms, variables), lever_m));
  }
  return offsets;
}

SmoothingForm::SmoothingForm(const Problem& problem, const FreeCoefficients& free,
                             Objective objective, double lever_m, double spread)
    : hessian_(Eigen::MatrixXd::Zero(free.size(), free.size())),
      slope_(StackedPoints::Zero(free.size(), 7)) {
  const Weights weights = weights_of(objective, free.knots().count, spread);
  const auto path_at = [&](int k) {
    return stacked(extended(problem.path, free.knots().knot_s(k)), lever_m);
  };
  for (int k = free.first() - 2; k <= free.last() + 2; ++k) {
    const double time_s = free.knots().knot_s(k);
    if (time_s < problem.path.begin_s() || time_s > problem.path.end_s()) continue;
    const StackedPoint here = path_at(k);
    Terms value;
    free.add(k, 1.0, value);
    count(weights.distance, value, here - stacked(extended(problem.original, time_s), lever_m));
    Terms step = value;
    free.add(k - 1, -1.0, step);
    count(weights.stretch, step, here - path_at(k - 1));
    Terms bend;
    free.add(k - 1, 1.0, bend);
    free.add(k, -2.0, bend);
    free.add(k + 1, 1.0, bend);
    count(weights.bend, bend, path_at(k - 1) - 2.0 * here + path_at(k + 1));
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(hessian_);
  inverse_ = factors.solve(Eigen::MatrixXd::Identity(free.size(), free.size()));
  minimum_ = -inverse_ * slope_;
}

void SmoothingForm::count(double weight, const Terms& terms, const StackedPoint& constant) {
  at_zero_ += 0.5 * weight * constant.squaredNorm();
  for (const Term& a : terms) {
    slope_.row(a.variable) += weight * a.share * constant.transpose();
    for (const Term& b : terms) hessian_(a.variable, b.variable) += weight * a.share * b.share;
  }
}

double SmoothingForm::value(const StackedPoints& variables) const {
  const StackedPoints curved = hessian_ * variables;
  return at_zero_ + slope_.cwiseProduct(variables).sum() +
         0.5 * curved.cwiseProduct(variables).sum();
}

}  // namespace camway::correction
