// SPDX-License-Identifier: MIT
#include "daemon/correction/path/closeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using geometry::Vec4;
using motion::CubicPath;
using motion::CubicPiece;

constexpr int kSamplesAPiece = 6;        // of the shift; even, for Simpson's rule
constexpr double kInside = 1e-6;         // share of a piece: beside its ends
constexpr double kBestSpacing = 12.0;    // from the derivative of the cost of a bump
constexpr double kPercentile = 0.99;     // of the acceleration
constexpr int kAccelerationSamples = 8;  // in a piece

/// Second derivative of a cubic Bézier curve at u.
template <class Point>
Point second_derivative(const std::array<Point, 4>& points, double duration_s, double u) {
  const Point first = points[0] - 2.0 * points[1] + points[2];
  const Point last = points[1] - 2.0 * points[2] + points[3];
  return 6.0 / (duration_s * duration_s) * ((1.0 - u) * first + u * last);
}

/// Calls `use(piece, other)` for each piece of `path` and the piece of `original` in which it lies.
template <class Use>
void for_each_pair(const CubicPath& path, const CubicPath& original, const Use& use) {
  std::size_t k = 0;
  for (const CubicPiece& piece : path.pieces) {
    const double middle_s = 0.5 * (piece.t0_s + piece.t1_s);
    while (k + 1 < original.pieces.size() && original.pieces[k].t1_s <= middle_s) ++k;
    use(piece, original.pieces[k]);
  }
}

bool is_same(const CubicPiece& a, const CubicPiece& b) {
  return a.t0_s == b.t0_s && a.t1_s == b.t1_s && a.position == b.position && a.image == b.image;
}

double turn_rad(const Vec4& image, const Vec4& other) {
  using motion::quaternion::multiply;
  const Vec4 a = multiply(image, image).normalized();
  const Vec4 b = multiply(other, other).normalized();
  const double apart = std::min((a - b).norm(), (a + b).norm());
  return 4.0 * std::asin(std::min(1.0, 0.5 * apart));
}

double shift_rad(const motion::CubicPoint& now, const motion::CubicPoint& before,
                 const Closeness& closeness) {
  const double moved_m = (now.position - before.position).norm();
  const double turned_rad = now.image == before.image ? 0.0 : turn_rad(now.image, before.image);
  return (moved_m + closeness.turn_lever_m * turned_rad) / closeness.viewing_distance_m;
}

/// Squared second derivative of the offset of `now` from `before` at u, with images by their lever.
double squared_acceleration(const CubicPiece& now, const CubicPath& original, double u,
                            const Closeness& closeness) {
  const double duration_s = now.t1_s - now.t0_s;
  // Inside the piece, where the original has one second derivative.
  const double time_s = std::lerp(now.t0_s, now.t1_s, std::clamp(u, kInside, 1.0 - kInside));
  const motion::CubicPoint before = original.second_derivative(time_s);
  const Vec3 moved = second_derivative(now.position, duration_s, u) - before.position;
  const Vec4 turned = second_derivative(now.image, duration_s, u) - before.image;
  const double lever_m = 4.0 * closeness.turn_lever_m;
  return moved.squaredNorm() + lever_m * lever_m * turned.squaredNorm();
}

double simpson_weight(int i, int steps) {
  return i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
}

/// ∫ shift dt over a piece, which lies in the piece `before` of the original path.
double integral_of_shift(const CubicPiece& piece, const CubicPiece& before,
                         const Closeness& closeness, double& largest_rad) {
  double sum = 0.0;
  for (int i = 0; i <= kSamplesAPiece; ++i) {
    const double time_s =
        std::lerp(piece.t0_s, piece.t1_s, static_cast<double>(i) / kSamplesAPiece);
    const double shift =
        shift_rad(motion::point_at(piece, time_s), motion::point_at(before, time_s), closeness);
    largest_rad = std::max(largest_rad, shift);
    sum += simpson_weight(i, kSamplesAPiece) * shift;
  }
  return sum * (piece.t1_s - piece.t0_s) / (3.0 * kSamplesAPiece);
}

}  // namespace

double Closeness::best_spacing_s(double height_m) const {
  const double product = kBestSpacing * kAccelerationWeight_rad * height_m * viewing_distance_m;
  return std::pow(product, 0.25) / std::sqrt(acceleration_m_per_s2);
}

Shift shift_of(const CubicPath& path, const CubicPath& original, const Closeness& closeness) {
  Shift shift;
  for_each_pair(path, original, [&](const CubicPiece& now, const CubicPiece& before) {
    if (is_same(now, before)) return;
    shift.mean_rad += integral_of_shift(now, before, closeness, shift.largest_rad);
  });
  shift.mean_rad /= path.end_s() - path.begin_s();
  return shift;
}

double closeness_cost(const CubicPath& path, const CubicPath& original,
                      const Closeness& closeness) {
  double cost = 0.0;
  double largest_rad = 0.0;
  const double a = closeness.acceleration_m_per_s2;
  for_each_pair(path, original, [&](const CubicPiece& now, const CubicPiece& before) {
    if (is_same(now, before)) return;
    cost += integral_of_shift(now, before, closeness, largest_rad);
    // The offset's second derivative is linear: Simpson's rule is exact for its square.
    const double squares = squared_acceleration(now, original, 0.0, closeness) +
                           4.0 * squared_acceleration(now, original, 0.5, closeness) +
                           squared_acceleration(now, original, 1.0, closeness);
    cost += kAccelerationWeight_rad * squares * (now.t1_s - now.t0_s) / 6.0 / (a * a);
  });
  return cost;
}

double reference_acceleration_m_per_s2(const CubicPath& interpolated, double viewing_distance_m) {
  struct Sample {
    double acceleration;
    double duration_s;
  };
  std::vector<Sample> samples;
  double length_m = 0.0;
  for (const CubicPiece& piece : interpolated.pieces) {
    const double duration_s = piece.t1_s - piece.t0_s;
    for (int i = 0; i < 3; ++i) {
      length_m += (piece.position[static_cast<std::size_t>(i) + 1] -
                   piece.position[static_cast<std::size_t>(i)])
                      .norm();
    }
    for (int i = 0; i < kAccelerationSamples; ++i) {
      const double u = (i + 0.5) / kAccelerationSamples;
      samples.push_back({second_derivative(piece.position, duration_s, u).norm(),
                         duration_s / kAccelerationSamples});
    }
  }
  const double whole_s = interpolated.end_s() - interpolated.begin_s();
  std::ranges::sort(samples, {}, &Sample::acceleration);
  double so_far_s = 0.0;
  double percentile = 0.0;
  for (const Sample& sample : samples) {
    percentile = sample.acceleration;
    so_far_s += sample.duration_s;
    if (so_far_s >= kPercentile * whole_s) break;
  }
  const double speed = length_m / whole_s;
  const double least =
      std::max(speed * speed / viewing_distance_m, std::numeric_limits<double>::min());
  return std::max(percentile, least);
}

}  // namespace camway::correction
