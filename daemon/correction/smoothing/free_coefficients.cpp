// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/free_coefficients.h"

#include <algorithm>

namespace camway::correction {

namespace {

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
    : knots_(knots), first_(2), last_(knots.count - 2) {
  if (ends == Ends::kFree) {
    const std::size_t leg = problem.leg;
    const std::vector<double>& times_s = problem.keyframes_s;
    const bool is_last = leg + 2 == times_s.size();
    first_ = leg == 0 ? -1 : -knots_beyond(knots, 0, -1, times_s[leg - 1]);
    last_ = knots.count + (is_last ? 1 : knots_beyond(knots, knots.count, 1, times_s[leg + 2]));
    hold(0);
    hold(knots.count);
  } else {
    for (int k = 1; k < knots.count; ++k) {
      if (std::ranges::binary_search(problem.keyframes_s, knots.knot_s(k))) hold(k);
    }
  }
  for (int k = first_; k <= last_; ++k) {
    variables_.push_back(is_held(k) ? kNoVariable : size_++);
    bumps_.push_back(knots.bump(k));
  }
}

void FreeCoefficients::hold(int knot) {
  const double peak = knots_.bump_at_knot(knot, knot);
  held_.push_back({knot, -knots_.bump_at_knot(knot - 1, knot) / peak,
                   -knots_.bump_at_knot(knot + 1, knot) / peak});
}

void FreeCoefficients::add(int k, double factor, Terms& terms) const {
  if (k < first_ || k > last_ || factor == 0.0) return;
  const Eigen::Index variable = this->variable(k);
  if (variable == kNoVariable) {
    const auto held = std::ranges::find(held_, k, &Held::knot);
    add(k - 1, factor * held->of_before, terms);
    add(k + 1, factor * held->of_after, terms);
    return;
  }
  const auto known = std::ranges::find(terms, variable, &Term::variable);
  if (known != terms.end()) {
    known->share += factor;
  } else {
    terms.push_back({variable, factor});
  }
}

Terms FreeCoefficients::at(double time_s) const {
  Terms terms;
  for (int k = first_; k <= last_; ++k) {
    const motion::KnotBump& bump = this->bump(k);
    if (bump.knots_s.back() <= time_s) continue;
    if (bump.knots_s.front() >= time_s) break;
    add(k, bump.value(time_s), terms);
  }
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

}  // namespace camway::correction
