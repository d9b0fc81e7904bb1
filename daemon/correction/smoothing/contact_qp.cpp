// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_qp.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "daemon/base/cpu_dispatch.h"

namespace camway::correction {

namespace {

/// Stacked points with an eighth number: processors handle two or four at a time.
using PaddedPoint = Eigen::Matrix<double, 8, 1>;
/// The same, one per row.
using PaddedPoints = Eigen::Matrix<double, Eigen::Dynamic, 8, Eigen::RowMajor>;

/// Adds `step` times `factors[i]` to each row i.
CAMWAY_FOR_EVERY_PROCESSOR
void add_to_rows(const double* factors, const StackedPoint& step, PaddedPoints& rows) {
  using Numbers = double __attribute__((vector_size(32)));
  const Numbers begin = {step[0], step[1], step[2], step[3]};
  const Numbers end = {step[4], step[5], step[6], 0.0};
  const Eigen::Index count = rows.rows();
  double* row = rows.data();
  for (Eigen::Index i = 0; i < count; ++i, row += 8) {
    Numbers first, second;
    std::memcpy(&first, row, sizeof first);
    std::memcpy(&second, row + 4, sizeof second);
    first += factors[i] * begin;
    second += factors[i] * end;
    std::memcpy(row, &first, sizeof first);
    std::memcpy(row + 4, &second, sizeof second);
  }
}

/// Keeps the variables up to date rather than the samples, of which there are many more. The bounds
/// of one sample are visited together, so that the force that they add is applied once.
class QpSolver {
 public:
  QpSolver(std::span<BoundConstraint> bounds, std::span<const Terms> samples,
           const Responses& responses, const StackedPoints& unforced)
      : bounds_(bounds),
        samples_(samples),
        responses_(responses),
        variables_(PaddedPoints::Zero(unforced.rows(), 8)) {
    variables_.leftCols<7>() = unforced;
    for_each_sample([&](std::size_t sample, std::span<BoundConstraint> of_sample) {
      const double response = own_response(samples_[sample], response_to(sample));
      StackedPoint force = StackedPoint::Zero();
      for (const BoundConstraint& bound : of_sample) {
        stiffness_.push_back(response * bound.direction.squaredNorm());
        force += bound.multiplier * bound.direction;
      }
      own_responses_.push_back(response);
      apply(sample, force);
    });
  }

  /// Updates each multiplier once. Returns the largest displacement of a sample.
  double sweep() {
    double largest_m = 0.0;
    std::size_t visited = 0;
    for_each_sample([&](std::size_t sample, std::span<BoundConstraint> of_sample) {
      largest_m = std::max(largest_m, update(sample, own_responses_[visited++], of_sample));
    });
    return largest_m;
  }

  [[nodiscard]] StackedPoints variables() const { return variables_.leftCols<7>(); }

 private:
  /// Calls `use(sample, bounds)` for the bounds of each sample, which are adjacent.
  template <class Use>
  void for_each_sample(const Use& use) {
    for (std::size_t begin = 0, end = 0; begin < bounds_.size(); begin = end) {
      const std::size_t sample = bounds_[begin].sample;
      while (end < bounds_.size() && bounds_[end].sample == sample) ++end;
      use(sample, bounds_.subspan(begin, end - begin));
    }
  }

  double update(std::size_t sample, double own_response, std::span<BoundConstraint> of_sample) {
    const auto first = static_cast<std::size_t>(of_sample.data() - bounds_.data());
    StackedPoint here = place_of(samples_[sample]);
    StackedPoint force = StackedPoint::Zero();
    double largest_m = 0.0;
    for (std::size_t i = 0; i < of_sample.size(); ++i) {
      BoundConstraint& bound = of_sample[i];
      const double stiffness = stiffness_[first + i];
      // A force has no effect on a sample with zero response.
      if (!(stiffness > 0.0)) continue;
      const double missing_m = bound.bound_m - here.dot(bound.direction);
      if (bound.multiplier == 0.0 && missing_m <= 0.0) continue;
      const double soft = bound.compliance * stiffness;
      const double wanted =
          bound.multiplier + (missing_m - soft * bound.multiplier) / (stiffness + soft);
      const double change = std::max(0.0, wanted) - bound.multiplier;
      bound.multiplier += change;
      force += change * bound.direction;
      here += own_response * change * bound.direction;
      largest_m = std::max(largest_m, std::abs(change) * stiffness);
    }
    apply(sample, force);
    return largest_m;
  }

  [[nodiscard]] StackedPoint place_of(const Terms& sample) const {
    PaddedPoint place = PaddedPoint::Zero();
    for (const Term& term : sample) place += term.share * variables_.row(term.variable).transpose();
    return place.head<7>();
  }

  void apply(std::size_t sample, const StackedPoint& force) {
    if (force.isZero(0.0)) return;
    add_to_rows(response_to(sample).data(), force, variables_);
  }

  [[nodiscard]] Responses::ConstColXpr response_to(std::size_t sample) const {
    return responses_.col(static_cast<Eigen::Index>(sample));
  }

  std::span<BoundConstraint> bounds_;
  std::span<const Terms> samples_;
  const Responses& responses_;
  PaddedPoints variables_;             ///< under the current multipliers
  std::vector<double> stiffness_;      ///< of each bound
  std::vector<double> own_responses_;  ///< of the samples with bounds, in their order
};

}  // namespace

Responses responses_of(std::span<const Terms> samples, const BandFactors& factors) {
  // All are solved for together, a row at a time.
  using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowByRow responses = RowByRow::Zero(factors.size(), static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const Term& term : samples[i]) {
      responses(term.variable, static_cast<Eigen::Index>(i)) = term.share;
    }
  }
  factors.solve_in_place(responses);
  return responses;
}

double own_response(const Terms& sample, const Eigen::Ref<const Eigen::VectorXd>& response) {
  double sum = 0.0;
  for (const Term& term : sample) sum += term.share * response[term.variable];
  return sum;
}

void solve_qp(std::span<BoundConstraint> bounds, std::span<const Terms> samples,
              const Responses& responses, double settled_m, int most_sweeps,
              StackedPoints& variables) {
  QpSolver solver(bounds, samples, responses, variables);
  for (int i = 0; i < most_sweeps && solver.sweep() >= settled_m; ++i) {
  }
  variables = solver.variables();
}

}  // namespace camway::correction
