// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/reference_frame.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "daemon/geometry/min_norm_point.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::motion {
namespace {

using geometry::Vec4;

// Tie-breakers of the least dot product: first the mean of the orientations, which keeps a constant
// axis, then a direction that is fixed relative to the middle orientation and not near axes in
// common use. Each weight is small against the quantity before it.
constexpr double kMeanWeight = 1e-3;
constexpr double kAnchorWeight = 1e-5;
const std::array<double, 4> kAnchor = {0.467, 0.641, 0.389, 0.471};

// Ascent: the number of best grid directions used, and of steps at each temperature of the smoothed
// minimum. The length of a step equals the temperature, at which the ascent contracts. The first
// temperature is too low to carry a start away from its gap in the polygon. The steps add up to
// less than 2, so rounding noise grows by at most exp(2).
constexpr std::size_t kStarts = 6;
constexpr int kStepsPerTemperature = 20;
constexpr std::array<double, 5> kTemperatures = {0.04, 0.02, 0.01, 0.005, 0.0025};

// Largest distance of the polygon's samples for the ascent. If there are more than `kMostSamples`,
// the ascent uses those nearest to -r, chosen again for each temperature: the others have little
// weight, and using all would take a hundred times as long as the rest.
constexpr double kSampleSpacing_rad = 0.2;
constexpr Eigen::Index kMostSamples = 2048;

double least_dot_with_arc(const Vec4& r, const Vec4& from, const Vec4& to) {
  const double a = r.dot(from);
  const double b = r.dot(to);
  const Vec4 across = to - from.dot(to) * from;
  const double sine = across.norm();
  if (!(sine > 0.0)) return std::min(a, b);
  // Along the arc the dot product is a·cos φ + slope·sin φ: its minimum is inside if it falls at
  // `from` and rises at `to`.
  const double slope = r.dot(across) / sine;
  const double slope_at_end = slope * from.dot(to) - a * sine;
  if (slope < 0.0 && slope_at_end > 0.0) return -std::hypot(a, slope);
  return std::min(a, b);
}

/// A point at the middle of the polygon, independent of its direction; its sign follows the data.
Vec4 middle_orientation(std::span<const Vec4> orientations) {
  const std::size_t n = orientations.size();
  return (orientations[(n - 1) / 2] + orientations[n / 2]).normalized();
}

/// Points of the polygon in columns.
using Samples = Eigen::Matrix<double, 4, Eigen::Dynamic>;

Samples polygon_samples(std::span<const Vec4> orientations) {
  std::vector<Vec4> samples;
  for (std::size_t i = 0; i + 1 < orientations.size(); ++i) {
    const Vec4& from = orientations[i];
    const Vec4& to = orientations[i + 1];
    const double angle_rad = std::atan2((to - from.dot(to) * from).norm(), from.dot(to));
    const int pieces = static_cast<int>(angle_rad / kSampleSpacing_rad) + 1;
    for (int k = i == 0 ? 0 : 1; k <= pieces; ++k) {
      const double u = static_cast<double>(k) / pieces;
      samples.push_back(((1.0 - u) * from + u * to).normalized());
    }
  }
  Samples columns(4, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = samples[i];
  return columns;
}

/// The directions of integer vectors with components in {-2 .. 2}, each once.
std::vector<Vec4> grid_directions() {
  std::vector<Vec4> directions;
  for (int code = 0; code < 625; ++code) {
    const Eigen::Vector4i v(code / 125 - 2, code / 25 % 5 - 2, code / 5 % 5 - 2, code % 5 - 2);
    const bool primitive = (v.array().abs() == 1).any();
    if (primitive) directions.push_back(v.cast<double>().normalized());
  }
  return directions;
}

class Search {
 public:
  explicit Search(std::span<const Vec4> orientations)
      : orientations_(orientations), samples_(polygon_samples(orientations)) {
    const Vec4 mean = samples_.rowwise().mean();
    const Vec4 middle = middle_orientation(orientations);
    preference_ = kMeanWeight * mean +
                  kAnchorWeight * quaternion::multiply(middle, Vec4(kAnchor.data()).normalized());
    for (const Vec4& direction : grid_directions()) add(quaternion::multiply(middle, direction));
    // The direction of a mean that is only noise would depend on the world frame.
    if (mean.norm() > kOpenHemisphere) add(mean.normalized());
  }

  [[nodiscard]] Vec4 best() {
    const std::vector<Candidate> starts = candidates_;
    for (const Candidate& start : starts) add(ascend(start.r));
    return candidates_.front().r;
  }

 private:
  struct Candidate {
    Vec4 r;
    double score;
  };

  /// Keeps `r` if it is among the best `kStarts` so far; most directions are dismissed after a few
  /// arcs of the polygon.
  void add(const Vec4& r) {
    const double preference = preference_.dot(r);
    const double floor = candidates_.size() < kStarts ? -2.0 : candidates_.back().score;
    double score = r.dot(orientations_.front()) + preference;
    for (std::size_t i = 0; i + 1 < orientations_.size(); ++i) {
      score = std::min(score,
                       least_dot_with_arc(r, orientations_[i], orientations_[i + 1]) + preference);
      if (score <= floor) return;
    }
    const auto worse = std::ranges::find_if(
        candidates_, [score](const Candidate& other) { return other.score < score; });
    candidates_.insert(worse, {r, score});
    if (candidates_.size() > kStarts) candidates_.pop_back();
  }

  /// Gradient of `-τ·log Σ exp(-r·p/τ)` over the samples p, plus the preference.
  [[nodiscard]] Vec4 gradient(const Samples& samples, const Vec4& r, double temperature) {
    dots_.noalias() = samples.transpose() * r;
    const double least = dots_.minCoeff();
    Vec4 sum = Vec4::Zero();
    double total = 0.0;
    for (Eigen::Index i = 0; i < dots_.size(); ++i) {
      const double exponent = (dots_[i] - least) / temperature;
      if (exponent > 40.0) continue;  // below the rounding of the sum
      const double weight = std::exp(-exponent);
      sum += weight * samples.col(i);
      total += weight;
    }
    return sum / total + preference_;
  }

  /// The samples that may have the least dot product with `r`; all if there are few enough.
  const Samples& samples_near(const Vec4& r) {
    if (samples_.cols() <= kMostSamples) return samples_;
    dots_.noalias() = samples_.transpose() * r;
    order_.resize(static_cast<std::size_t>(samples_.cols()));
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    const auto by_dot = [&](Eigen::Index a, Eigen::Index b) {
      return dots_[a] != dots_[b] ? dots_[a] < dots_[b] : a < b;
    };
    std::ranges::nth_element(order_, order_.begin() + kMostSamples, by_dot);
    std::ranges::sort(order_.begin(), order_.begin() + kMostSamples);
    near_.resize(4, kMostSamples);
    for (Eigen::Index i = 0; i < kMostSamples; ++i)
      near_.col(i) = samples_.col(order_[static_cast<std::size_t>(i)]);
    return near_;
  }

  [[nodiscard]] Vec4 ascend(Vec4 r) {
    for (const double temperature : kTemperatures) {
      const Samples& samples = samples_near(r);
      for (int i = 0; i < kStepsPerTemperature; ++i)
        r = (r + temperature * gradient(samples, r, temperature)).normalized();
    }
    return r;
  }

  std::span<const Vec4> orientations_;
  Samples samples_;
  Vec4 preference_;
  std::vector<Candidate> candidates_;  ///< best first
  Eigen::VectorXd dots_;
  std::vector<Eigen::Index> order_;
  Samples near_;
};

}  // namespace

double least_dot_with_polygon(const Vec4& r, std::span<const Vec4> orientations) {
  assert(!orientations.empty());
  double least = r.dot(orientations.front());
  for (std::size_t i = 0; i + 1 < orientations.size(); ++i)
    least = std::min(least, least_dot_with_arc(r, orientations[i], orientations[i + 1]));
  return std::clamp(least, -1.0, 1.0);
}

Vec4 reference_frame(std::span<const Vec4> orientations) {
  const Vec4 nearest = min_norm_point(orientations);
  const double distance = nearest.norm();
  if (distance > kOpenHemisphere) return nearest / distance;
  return Search(orientations).best();
}

}  // namespace camway::motion
