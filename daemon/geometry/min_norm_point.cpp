// SPDX-License-Identifier: MIT
#include "daemon/geometry/min_norm_point.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/QR>

namespace camway::motion {
namespace {

using geometry::Vec4;

// Limit of major steps. Real data needs a handful; the limit only stops cycles due to rounding.
constexpr int kMaxMajorSteps = 200;

/// Points in general position whose hull holds the iterate, with its barycentric weights: Wolfe's
/// "corral".
struct Corral {
  std::vector<Vec4> points;
  std::vector<double> weights;

  [[nodiscard]] Vec4 iterate() const {
    Vec4 sum = Vec4::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) sum += weights[i] * points[i];
    return sum;
  }
};

/// Barycentric weights of the point closest to the origin in the affine hull of `points`.
std::vector<double> affine_minimiser(const std::vector<Vec4>& points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  std::vector<double> weights(points.size(), 0.0);
  weights[0] = 1.0;
  if (count == 1) return weights;
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, 4> differences(4, count - 1);
  for (Eigen::Index i = 1; i < count; ++i)
    differences.col(i - 1) = points[static_cast<std::size_t>(i)] - points[0];
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> solution =
      differences.colPivHouseholderQr().solve(-points[0]);
  for (std::size_t i = 1; i < points.size(); ++i) {
    weights[i] = solution[static_cast<Eigen::Index>(i - 1)];
    weights[0] -= weights[i];
  }
  return weights;
}

/// Moves from the current weights towards `target` until a weight vanishes, and drops those points.
/// Returns whether the target was reached.
bool move_towards(const std::vector<double>& target, Corral& corral) {
  double step = 1.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target[i] <= 0.0)
      step = std::min(step, corral.weights[i] / (corral.weights[i] - target[i]));
  }
  bool dropped = false;
  Corral kept;
  for (std::size_t i = 0; i < target.size(); ++i) {
    const double weight = corral.weights[i] + step * (target[i] - corral.weights[i]);
    const bool blocks =
        target[i] <= 0.0 && corral.weights[i] / (corral.weights[i] - target[i]) <= step;
    if (blocks || weight <= 0.0) {
      dropped = true;
      continue;
    }
    kept.points.push_back(corral.points[i]);
    kept.weights.push_back(weight);
  }
  if (kept.points.empty()) return true;  // only rounding can empty it: keep what there is
  corral = std::move(kept);
  return !dropped;
}

}  // namespace

Vec4 min_norm_point(std::span<const Vec4> points) {
  assert(!points.empty());
  const auto lowest = [&](const Vec4& direction) {
    return *std::ranges::min_element(points, std::ranges::less{},
                                     [&](const Vec4& p) { return direction.dot(p); });
  };
  Corral corral{{points[0]}, {1.0}};
  Vec4 iterate = points[0];
  Vec4 best = iterate;
  double best_gap = std::numeric_limits<double>::infinity();
  for (int major = 0; major < kMaxMajorSteps; ++major) {
    const Vec4 next = lowest(iterate);
    const double gap = iterate.squaredNorm() - iterate.dot(next);
    if (gap < best_gap) {
      best_gap = gap;
      best = iterate;
    }
    // Lengths cannot distinguish iterates of a cluster, as its gaps enter them squared.
    if (gap <= kMinNormGap) break;
    if (std::ranges::find(corral.points, next) != corral.points.end()) break;
    if (corral.points.size() > 4) break;  // a simplex around the origin: all the rest is rounding
    corral.points.push_back(next);
    corral.weights.push_back(0.0);
    while (!move_towards(affine_minimiser(corral.points), corral)) {
    }
    iterate = corral.iterate();
  }
  return best;
}

}  // namespace camway::motion
