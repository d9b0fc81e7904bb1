// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_qp.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "daemon/base/cpu_dispatch.h"

namespace camway::correction {

namespace {

/// Stacked points, one per row, with an eighth number: processors handle two or four at a time.
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

/// Keeps the displaced samples up to date. The bounds of one sample are visited together, so that
/// the force that they add is applied to all other samples once.
class QpSolver {
 public:
  QpSolver(std::span<BoundConstraint> bounds, const StackedPoints& unforced,
           const Eigen::MatrixXd& response)
      : bounds_(bounds), response_(response), displaced_(PaddedPoints::Zero(unforced.rows(), 8)) {
    displaced_.leftCols<7>() = unforced;
    for_each_sample([&](Eigen::Index sample, std::span<BoundConstraint> of_sample) {
      StackedPoint force = StackedPoint::Zero();
      for (const BoundConstraint& bound : of_sample) {
        stiffness_.push_back(response_(sample, sample) * bound.direction.squaredNorm());
        force += bound.multiplier * bound.direction;
      }
      apply(sample, force);
    });
  }

  /// Updates each multiplier once. Returns the largest displacement of a sample.
  double sweep() {
    double largest_m = 0.0;
    for_each_sample([&](Eigen::Index sample, std::span<BoundConstraint> of_sample) {
      largest_m = std::max(largest_m, update(sample, of_sample));
    });
    return largest_m;
  }

 private:
  /// Calls `use(sample, bounds)` for the bounds of each sample, which are adjacent.
  template <class Use>
  void for_each_sample(const Use& use) {
    for (std::size_t begin = 0, end = 0; begin < bounds_.size(); begin = end) {
      const std::size_t sample = bounds_[begin].sample;
      while (end < bounds_.size() && bounds_[end].sample == sample) ++end;
      use(static_cast<Eigen::Index>(sample), bounds_.subspan(begin, end - begin));
    }
  }

  double update(Eigen::Index sample, std::span<BoundConstraint> of_sample) {
    const double own_response = response_(sample, sample);
    const auto first = static_cast<std::size_t>(of_sample.data() - bounds_.data());
    StackedPoint here = displaced_.row(sample).head<7>();
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

  void apply(Eigen::Index sample, const StackedPoint& force) {
    if (force.isZero(0.0)) return;
    add_to_rows(response_.col(sample).data(), force, displaced_);
  }

  std::span<BoundConstraint> bounds_;
  const Eigen::MatrixXd& response_;
  PaddedPoints displaced_;  ///< the samples under the current multipliers
  std::vector<double> stiffness_;
};

}  // namespace

void solve_qp(std::span<BoundConstraint> bounds, const StackedPoints& unforced,
              const Eigen::MatrixXd& response, double settled_m, int most_sweeps) {
  QpSolver solver(bounds, unforced, response);
  for (int i = 0; i < most_sweeps && solver.sweep() >= settled_m; ++i) {
  }
}

}  // namespace camway::correction
