// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_forces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace camway::correction {

namespace {

// Chosen by measurement.
constexpr int kMostSweeps = 10;          // over the active set
constexpr int kMostRounds = 3;           // of extending the active set
constexpr std::size_t kMostLive = 1024;  // largest active set: its compliances are stored

class Forces {
 public:
  Forces(std::span<ForcedBound> bounds, const StackedPoints& unforced, const Eigen::MatrixXd& reply)
      : bounds_(bounds), unforced_(unforced), reply_(reply), is_live_(bounds.size()) {
    for (const ForcedBound& bound : bounds) {
      const auto sample = static_cast<Eigen::Index>(bound.sample);
      stiffness_.push_back(reply(sample, sample) * bound.direction.squaredNorm());
    }
  }

  /// Adds the violated bounds to the active set, the most violated first. Returns whether there
  /// were any.
  bool add_live() {
    const StackedPoints now = forced();
    std::vector<Missing> found;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      // A force has no effect on a sample with zero compliance.
      if (is_live_[i] || !(stiffness_[i] > 0.0)) continue;
      const ForcedBound& bound = bounds_[i];
      const double missing_m =
          bound.bound_m - now.row(static_cast<Eigen::Index>(bound.sample)).dot(bound.direction);
      if (bound.force == 0.0 && missing_m <= 0.0) continue;
      found.push_back({missing_m, i});
    }
    const std::size_t room = kMostLive - std::min(kMostLive, live_.size());
    if (found.size() > room) {
      std::ranges::stable_sort(found, std::greater(), &Missing::by_m);
      found.resize(room);
    }
    for (const Missing& missing : found) is_live_[missing.bound] = true;
    if (!found.empty()) set_up(now);
    return !found.empty();
  }

  /// Updates each multiplier once. Returns the largest displacement of a sample.
  double sweep() {
    double largest_m = 0.0;
    for (std::size_t j = 0; j < live_.size(); ++j) {
      ForcedBound& bound = bounds_[live_[j]];
      const auto place = static_cast<Eigen::Index>(j);
      if (bound.force == 0.0 && missing_m_[place] <= 0.0) continue;
      const double stiffness = stiffness_[live_[j]];
      const double soft = bound.softness * stiffness;
      const double wanted =
          bound.force + (missing_m_[place] - soft * bound.force) / (stiffness + soft);
      const double change = std::max(0.0, wanted) - bound.force;
      if (change == 0.0) continue;
      bound.force += change;
      missing_m_ -= change * replies_.col(place);
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
      if (bounds_[i].force > 0.0) force += bounds_[i].force * bounds_[i].direction;
      const bool is_last = i + 1 == bounds_.size() || bounds_[i + 1].sample != bounds_[i].sample;
      if (!is_last || force.isZero(0.0)) continue;
      const auto sample = static_cast<Eigen::Index>(bounds_[i].sample);
      now.noalias() += reply_.col(sample) * force.transpose();
      force.setZero();
    }
    return now;
  }

  void set_up(const StackedPoints& now) {
    live_.clear();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (is_live_[i]) live_.push_back(i);
    }
    const auto count = static_cast<Eigen::Index>(live_.size());
    missing_m_.resize(count);
    replies_.resize(count, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const ForcedBound& a = bounds_[live_[static_cast<std::size_t>(j)]];
      const auto sample = static_cast<Eigen::Index>(a.sample);
      missing_m_[j] = a.bound_m - now.row(sample).dot(a.direction);
      for (Eigen::Index i = 0; i <= j; ++i) {
        const ForcedBound& b = bounds_[live_[static_cast<std::size_t>(i)]];
        replies_(i, j) = replies_(j, i) =
            reply_(static_cast<Eigen::Index>(b.sample), sample) * a.direction.dot(b.direction);
      }
    }
  }

  std::span<ForcedBound> bounds_;
  const StackedPoints& unforced_;
  const Eigen::MatrixXd& reply_;
  std::vector<bool> is_live_;
  std::vector<double> stiffness_;
  std::vector<std::size_t> live_;
  Eigen::VectorXd missing_m_;  ///< violation of each active bound; below 0 where it holds
  Eigen::MatrixXd replies_;    ///< compliance matrix of the active bounds
};

}  // namespace

void find_forces(std::span<ForcedBound> bounds, const StackedPoints& unforced,
                 const Eigen::MatrixXd& reply, double settled_m) {
  Forces forces(bounds, unforced, reply);
  for (int round = 0; round < kMostRounds && forces.add_live(); ++round) {
    for (int i = 0; i < kMostSweeps && forces.sweep() >= settled_m; ++i) {
    }
  }
}

}  // namespace camway::correction
