// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/constrained_minimum.h"

#include <algorithm>

namespace camway::correction {

namespace {

// Chosen by measurement.
constexpr double kMultiplierSettled = 1e-3;  // in radii of the ball
constexpr double kWorthOfRoom = 0.6;         // of all missing gaps together, relative to the form
constexpr int kSweepsOfCurve = 40;    // a curve that hugs what it passes has many tight bounds
constexpr int kSweepsToSettle = 400;  // bounds that face each other take hundreds

}  // namespace

ConstrainedMinimum::ConstrainedMinimum(const SmoothingForm& form, const Improvement& improvement,
                                       double ball_radius_m, double viewing_distance_m)
    : form_(form),
      bounds_(improvement.objective, ball_radius_m, viewing_distance_m),
      settled_m_(kMultiplierSettled * ball_radius_m),
      usual_sweeps_(measures_curve(improvement.objective) ? kSweepsOfCurve : kFewSweeps),
      may_turn_(improvement.may_turn),
      has_no_price_(improvement.makes_room) {}

StackedPoints ConstrainedMinimum::find(const StackedPoints& variables,
                                       std::vector<PathSample>& samples, Convergence convergence) {
  StackedPoints result = form_.minimum();
  if (!may_turn_) result.rightCols<4>() = variables.rightCols<4>();
  find_touching(samples);
  if (has_no_price_) price_room(variables, samples);
  bounds_.clear();
  if (touching_.empty()) return result;
  const Responses responses = responses_of(terms_, form_.factors());
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    const double response = own_response(terms_[i], responses.col(static_cast<Eigen::Index>(i)));
    bounds_.add(i, combined(terms_[i], variables), response, touching_[i]->rows);
  }
  const int sweeps = convergence == Convergence::kSettled ? kSweepsToSettle : usual_sweeps_;
  solve_qp(bounds_.bounds(), terms_, responses, settled_m_, sweeps, result);
  bounds_.remember();
  return result;
}

void ConstrainedMinimum::price_room(const StackedPoints& variables,
                                    const std::vector<PathSample>& samples) {
  double missing_m2 = 0.0;
  for (const PathSample& sample : samples) {
    for (const Contact& contact : sample.rows) {
      const double missing_m = std::max(0.0, wanted_m() - contact.row.room_m);
      missing_m2 += missing_m * missing_m;
    }
  }
  if (missing_m2 == 0.0) return;
  bounds_.set_price_of_room(2.0 * kWorthOfRoom * form_.value(variables) / missing_m2);
  has_no_price_ = false;
}

void ConstrainedMinimum::find_touching(std::vector<PathSample>& samples) {
  touching_.clear();
  terms_.clear();
  for (PathSample& sample : samples) {
    if (sample.contacts.empty()) continue;
    touching_.push_back(&sample);
    terms_.push_back(sample.terms);
  }
}

}  // namespace camway::correction
