// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/rate_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;
using Bivector = Eigen::Matrix<double, 6, 1>;

// Each halving reduces the error of bounds by coefficients to a quarter: after ten it is a
// millionth of the rate's variation on the segment.
constexpr int kHalvings = 10;

Bivector wedge(const Vec4& a, const Vec4& b) {
  Bivector result;
  result << a[0] * b[1] - a[1] * b[0], a[0] * b[2] - a[2] * b[0], a[0] * b[3] - a[3] * b[0],
      a[1] * b[2] - a[2] * b[1], a[1] * b[3] - a[3] * b[1], a[2] * b[3] - a[3] * b[2];
  return result;
}

template <class Value, std::size_t N>
double longest(const std::array<Value, N>& coefficients) {
  double length = 0.0;
  for (const Value& coefficient : coefficients) length = std::max(length, coefficient.norm());
  return length;
}

template <class Value, std::size_t N>
std::array<Value, N - 1> hodograph(const std::array<Value, N>& curve) {
  std::array<Value, N - 1> result;
  for (std::size_t i = 0; i + 1 < N; ++i)
    result[i] = static_cast<double>(N - 1) * (curve[i + 1] - curve[i]);
  return result;
}

/// Bernstein coefficients of the squared length.
template <class Value, std::size_t N>
std::array<double, 2 * N - 1> squared_length(const std::array<Value, N>& curve) {
  return bezier::product(curve, curve, [](const Value& a, const Value& b) { return a.dot(b); });
}

/// Whether the polynomial with these Bernstein coefficients is shown to be nowhere negative.
template <std::size_t N>
bool is_nowhere_negative(const std::array<double, N>& polynomial, int halvings) {
  if (std::ranges::all_of(polynomial, [](double value) { return value >= 0.0; })) return true;
  if (halvings == 0 || !(bezier::value_at(polynomial, 0.5) >= 0.0)) return false;
  return is_nowhere_negative(bezier::sub_curve(polynomial, 0.0, 0.5), halvings - 1) &&
         is_nowhere_negative(bezier::sub_curve(polynomial, 0.5, 1.0), halvings - 1);
}

bool meets_speed(const std::array<Vec3, 3>& velocity, double limit) {
  std::array<double, 5> room = squared_length(velocity);
  for (double& value : room) value = 1.0 - value / limit / limit;
  return is_nowhere_negative(room, kHalvings);
}

/// `limit` is in radians for the whole segment.
bool meets_turn_rate(const Segment& segment, double limit) {
  const std::array<double, 13> weights = orientation_weights(segment);
  std::array<double, 25> room = bezier::product(weights, weights, std::multiplies<>());
  const std::array<double, 25> turning = bezier::elevated<2>(
      squared_length(bezier::product(segment.orientation, hodograph(segment.orientation), wedge)));
  for (std::size_t i = 0; i < room.size(); ++i) room[i] -= 4.0 * turning[i] / limit / limit;
  return is_nowhere_negative(room, kHalvings);
}

}  // namespace

RateLimits scaled_limits(const RateLimits& limits, double factor) {
  return {limits.speed_m_per_s * factor, limits.acceleration_m_per_s2 * factor * factor,
          limits.turn_rate_rad_per_s * factor};
}

double SlowDowns::largest() const { return std::max({speed, acceleration, turn_rate}); }

SlowDowns slow_downs(const Segment& segment, double u, const RateLimits& limits) {
  const SegmentDerivatives at = derivatives_at(segment, u);
  return {at.velocity_m_per_s.norm() / limits.speed_m_per_s,
          std::sqrt(at.acceleration_m_per_s2.norm() / limits.acceleration_m_per_s2),
          2.0 * at.orientation_rate_per_s.norm() / limits.turn_rate_rad_per_s};
}

double needed_slow_down(const Segment& segment, double u, const RateLimits& limits) {
  return slow_downs(segment, u, limits).largest();
}

bool meets(const Segment& segment, const RateLimits& limits) {
  const double duration_s = segment.t1_s - segment.t0_s;
  const std::array<Vec3, 3> velocity = hodograph(segment.position);
  if (longest(hodograph(velocity)) > limits.acceleration_m_per_s2 * duration_s * duration_s)
    return false;
  if (!meets_speed(velocity, limits.speed_m_per_s * duration_s)) return false;
  return std::isinf(limits.turn_rate_rad_per_s) ||
         meets_turn_rate(segment, limits.turn_rate_rad_per_s * duration_s);
}

bool meets(const Path& path, const RateLimits& limits) {
  return std::ranges::all_of(path.segments(),
                             [&](const Segment& segment) { return meets(segment, limits); });
}

}  // namespace camway::motion
