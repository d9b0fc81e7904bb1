// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/constrained_minimum.h"

#include <map>
#include <span>

namespace camway::correction {

namespace {

constexpr double kForceSettled = 1e-3;  // in radii of the ball; chosen by measurement

}  // namespace

ConstrainedMinimum::ConstrainedMinimum(const SmoothingForm& form, Objective objective,
                                       double ball_radius_m, double viewing_distance_m,
                                       bool may_turn)
    : form_(form),
      bounds_(objective, ball_radius_m, viewing_distance_m),
      settled_m_(kForceSettled * ball_radius_m),
      may_turn_(may_turn) {}

void ConstrainedMinimum::forget_form() {
  unforced_.resize(0, 7);
  response_.resize(0, 0);
}

StackedPoints ConstrainedMinimum::find(const StackedPoints& variables,
                                       std::vector<PathSample>& samples) {
  StackedPoints result = form_.minimum();
  if (!may_turn_) result.rightCols<4>() = variables.rightCols<4>();
  find_bounds(variables, samples);
  const std::span<BoundConstraint> bounds = bounds_.bounds();
  if (bounds.empty()) return result;
  solve_qp(bounds, unforced(result, samples), response(samples), settled_m_);
  std::map<Eigen::Index, StackedPoint> forces;
  for (const BoundConstraint& bound : bounds) {
    if (bound.multiplier == 0.0) continue;
    for (const Term& term : samples[bound.sample].terms) {
      auto [force, is_new] = forces.try_emplace(term.variable, StackedPoint::Zero());
      force->second += term.share * bound.multiplier * bound.direction;
    }
  }
  for (const auto& [variable, force] : forces) {
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
      result.row(i) += form_.inverse()(i, variable) * force.transpose();
    }
  }
  bounds_.remember();
  return result;
}

void ConstrainedMinimum::find_bounds(const StackedPoints& variables,
                                     std::vector<PathSample>& samples) {
  bounds_.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    PathSample& sample = samples[i];
    if (sample.contacts.empty()) continue;
    const auto place = static_cast<Eigen::Index>(i);
    bounds_.add(i, combined(sample.terms, variables), response(samples)(place, place), sample.rows);
  }
}

const StackedPoints& ConstrainedMinimum::unforced(const StackedPoints& minimum,
                                                  const std::vector<PathSample>& samples) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  const Eigen::Index old = unforced_.rows();
  if (old == count) return unforced_;
  unforced_.conservativeResize(count, 7);
  for (Eigen::Index i = old; i < count; ++i) {
    unforced_.row(i) = combined(samples[static_cast<std::size_t>(i)].terms, minimum);
  }
  return unforced_;
}

const Eigen::MatrixXd& ConstrainedMinimum::response(const std::vector<PathSample>& samples) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  const Eigen::Index known = response_.cols();
  response_.conservativeResize(count, count);
  for (Eigen::Index j = known; j < count; ++j) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(form_.minimum().rows());
    for (const Term& term : samples[static_cast<std::size_t>(j)].terms) {
      moved += term.share * form_.inverse().col(term.variable);
    }
    for (Eigen::Index i = 0; i <= j; ++i) {
      double sum = 0.0;
      for (const Term& term : samples[static_cast<std::size_t>(i)].terms) {
        sum += term.share * moved[term.variable];
      }
      response_(i, j) = response_(j, i) = sum;
    }
  }
  return response_;
}

}  // namespace camway::correction
