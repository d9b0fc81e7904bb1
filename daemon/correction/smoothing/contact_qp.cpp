// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_qp.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace camway::correction {

namespace {

// Chosen by measurement.
constexpr int kMostSweeps = 10;            // over the active set
constexpr int kMostRounds = 3;             // of extending the active set
constexpr std::size_t kMostActive = 1024;  // largest active set: its responses are stored

class QpSolver {
 public:
  QpSolver(std::span<BoundConstraint> bounds, const StackedPoints& unforced,
           const Eigen::MatrixXd& response)
      : bounds_(bounds), unforced_(unforced), response_(response), is_active_(bounds.size()) {
    for (const BoundConstraint& bound : bounds) {
      const auto sample = static_cast<Eigen::Index>(bound.sample);
      stiffness_.push_back(response(sample, sample) * bound.direction.squaredNorm());
    }
  }

  /// Adds the violated bounds to the active set, the most violated first. Returns whether there
  /// were any.
  bool add_active() {
    const StackedPoints now = forced();
    std::vector<Missing> found;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      // A force has no effect on a sample with zero response.
      if (is_active_[i] || !(stiffness_[i] > 0.0)) continue;
      const BoundConstraint& bound = bounds_[i];
      const double missing_m =
          bound.bound_m - now.row(static_cast<Eigen::Index>(bound.sample)).dot(bound.direction);
      if (bound.multiplier == 0.0 && missing_m <= 0.0) continue;
      found.push_back({missing_m, i});
    }
    const std::size_t room = kMostActive - std::min(kMostActive, active_.size());
    if (found.size() > room) {
      std::ranges::stable_sort(found, std::greater(), &Missing::by_m);
      found.resize(room);
    }
    for (const Missing& missing : found) is_active_[missing.bound] = true;
    if (!found.empty()) set_up(now);
    return !found.empty();
  }

  /// Updates each multiplier once. Returns the largest displacement of a sample.
  double sweep() {
    double largest_m = 0.0;
    for (std::size_t j = 0; j < active_.size(); ++j) {
      BoundConstraint& bound = bounds_[active_[j]];
      const auto place = static_cast<Eigen::Index>(j);
      if (bound.multiplier == 0.0 && missing_m_[place] <= 0.0) continue;
      const double stiffness = stiffness_[active_[j]];
      const double soft = bound.compliance * stiffness;
      const double wanted =
          bound.multiplier + (missing_m_[place] - soft * bound.multiplier) / (stiffness + soft);
      const double change = std::max(0.0, wanted) - bound.multiplier;
      if (change == 0.0) continue;
      bound.multiplier += change;
      missing_m_ -= change * active_response_.col(place);
      largest_m = std::max(largest_m, std::abs(change) * stiffness);
    }
    return largest_m;
  }

 private:
  struct Missing {
    double by_m;
    std::size_t bound;
  };

  /// The samples under the current multipliers. Bounds of one sample are adjacent.
  [[nodiscard]] StackedPoints forced() const {
    StackedPoints now = unforced_;
    StackedPoint force = StackedPoint::Zero();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (bounds_[i].multiplier > 0.0) force += bounds_[i].multiplier * bounds_[i].direction;
      const bool is_last = i + 1 == bounds_.size() || bounds_[i + 1].sample != bounds_[i].sample;
      if (!is_last || force.isZero(0.0)) continue;
      const auto sample = static_cast<Eigen::Index>(bounds_[i].sample);
      now.noalias() += response_.col(sample) * force.transpose();
      force.setZero();
    }
    return now;
  }

  void set_up(const StackedPoints& now) {
    active_.clear();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (is_active_[i]) active_.push_back(i);
    }
    const auto count = static_cast<Eigen::Index>(active_.size());
    missing_m_.resize(count);
    active_response_.resize(count, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const BoundConstraint& a = bounds_[active_[static_cast<std::size_t>(j)]];
      const auto sample = static_cast<Eigen::Index>(a.sample);
      missing_m_[j] = a.bound_m - now.row(sample).dot(a.direction);
      for (Eigen::Index i = 0; i <= j; ++i) {
        const BoundConstraint& b = bounds_[active_[static_cast<std::size_t>(i)]];
        active_response_(i, j) = active_response_(j, i) =
            response_(static_cast<Eigen::Index>(b.sample), sample) * a.direction.dot(b.direction);
      }
    }
  }

  std::span<BoundConstraint> bounds_;
  const StackedPoints& unforced_;
  const Eigen::MatrixXd& response_;
  std::vector<bool> is_active_;
  std::vector<double> stiffness_;
  std::vector<std::size_t> active_;
  Eigen::VectorXd missing_m_;        ///< violation of each active bound; below 0 where it holds
  Eigen::MatrixXd active_response_;  ///< response of the active bounds to each other
};

}  // namespace

void solve_qp(std::span<BoundConstraint> bounds, const StackedPoints& unforced,
              const Eigen::MatrixXd& response, double settled_m) {
  QpSolver solver(bounds, unforced, response);
  for (int round = 0; round < kMostRounds && solver.add_active(); ++round) {
    for (int i = 0; i < kMostSweeps && solver.sweep() >= settled_m; ++i) {
    }
  }
}

}  // namespace camway::correction
