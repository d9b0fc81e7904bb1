// SPDX-License-Identifier: MIT
#include "daemon/motion/path/stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;

// Upper bound of the rounding of chains of fewer than sixteen operations on positive numbers, half
// an epsilon each.
constexpr double kRoundUp = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();

// Largest turn whose first order is used.
constexpr double kLargestTangent = 0.25;

// Rounding of a series of degree n whose control points differ by at most E per coordinate, in
// units of rounding u = 2^-53 (half of an epsilon) times E:
// 1. Differences to the first control point: 1. De Casteljau at 1/2: one sum a level: n.
// 2. The coefficient of v^k about the middle is C(n,k)·2^k times the k-th difference of the control
//    points of the right half. Their errors grow by 2^k, k levels of differences add k·2^k, the
//    product 2^k: in all C(n,k)·4^k·(n + 2 + k).
// 3. Shifting to m = 1/2 + v: the coefficients C(j,k)·v^(j-k) meet (|v| + h)^j <= 2^-j in Σ
//    h^k|Pₖ|, so the errors of 2. add up to Σ_j C(n,j)·2^j·(n + 2 + j) = (n+2)·3^n + 2n·3^(n-1);
//    the shift itself has at most 2n operations on each term of a sum below 2^n: 2n·2^n.
// n = 3: 189 + 48 = 237, and √3 from coordinates to length: 411 u = 206 epsilons.
constexpr double kPositionSeriesRounding = 210.0 * std::numeric_limits<double>::epsilon();
// n = 6: 8748 + 768 = 9516, times 2 from coordinates to length; the parts along and across the
// middle have 8 more operations on terms that sum up to 2^6, and the first order 24: 2048. 23128 u
// = 11564 epsilons.
constexpr double kOrientationSeriesRounding = 11776.0 * std::numeric_limits<double>::epsilon();
// Rounding of adding the first control point, and of the direction of the middle, relative to the
// value.
constexpr double kValueRounding = 4.0 * std::numeric_limits<double>::epsilon();
// Rounding of the rotation matrix of a quaternion of any length: its entries are within 16 units,
// its product with a point at radius ρ within 60 units of ρ.
constexpr double kMatrixRounding = 60.0 * std::numeric_limits<double>::epsilon();
// Rounding of a step: its products and sums have fewer than 32 roundings of the numbers added.
constexpr double kStepRounding = 16.0 * std::numeric_limits<double>::epsilon();

template <class Value, std::size_t N>
double largest_difference(const std::array<Value, N>& points) {
  double length = 0.0;
  for (const Value& point : points) length = std::max(length, (point - points[0]).norm());
  // Adds rather than compares: a comparison would drop "not a number".
  double sum = 0.0;
  for (const Value& point : points) sum += (point - points[0]).squaredNorm();
  return std::isfinite(sum) ? length : std::numeric_limits<double>::infinity();
}

/// Coefficients of v^k, v = u - 1/2, of the curve less its first control point.
template <class Value, std::size_t N>
std::array<Value, N> series_about_middle(std::array<Value, N> points) {
  constexpr std::size_t kDegree = N - 1;
  const Value first = points[0];
  for (Value& point : points) point -= first;
  std::array<Value, N> right;  // control points of the right half
  for (std::size_t count = N; count > 0; --count) {
    right[count - 1] = points[count - 1];
    for (std::size_t i = 0; i + 1 < count; ++i) points[i] = 0.5 * (points[i] + points[i + 1]);
  }
  double power = 1.0;
  std::array<Value, N> series;
  for (std::size_t k = 0; k < N; ++k) {
    series[k] = bezier::binomial(kDegree, k) * power * right[0];
    power *= 2.0;
    for (std::size_t i = 0; i + 1 < N - k; ++i) right[i] = right[i + 1] - right[i];
  }
  return series;
}

/// The same polynomial in powers of (v - shift): Horner's scheme, repeated.
template <class Value, std::size_t N>
void shift_series(std::array<Value, N>& series, double shift) {
  for (std::size_t i = 0; i + 1 < N; ++i) {
    for (std::size_t j = N - 1; j-- > i;) series[j] += shift * series[j + 1];
  }
}

Eigen::Matrix3d rotation_of(const Vec4& q, double squared_length) {
  const double s = 2.0 / squared_length;
  const double w = q[0];
  const double x = q[1];
  const double y = q[2];
  const double z = q[3];
  Eigen::Matrix3d R;
  R << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return R;
}

/// Sine of the angle whose tangent is across / along; 1 if that may be a right angle or more.
double sine_of(double across, double along) {
  if (!(along > 0.0)) return 1.0;
  const double tangent = across / along;
  return std::min(1.0, tangent / std::sqrt(1.0 + tangent * tangent) * kRoundUp);
}

/// Vector part of `rate` times the conjugate of the unit quaternion `q`.
Vec3 vector_part(const Vec4& rate, const Vec4& q) {
  const Vec3 u = rate.tail<3>();
  const Vec3 v = q.tail<3>();
  return q[0] * u - rate[0] * v - u.cross(v);
}

/// Sets the turn to a bound without direction.
void go_nowhere(Stretch& stretch) {
  stretch.turn_step_W = Vec3::Zero();
  stretch.turn_bend = 2.0 * stretch.turn_sine;
}

double reach_of(double travel_m, double turn_sine, double radius_m) {
  return (travel_m + 2.0 * radius_m * turn_sine) * kRoundUp;
}

}  // namespace

double Stretch::reach_m(double radius_m) const {
  const double eye_m = eye_W.norm() + radius_m;
  return reach_of(travel_m + travel_rounding_m, turn_sine, radius_m) + kMatrixRounding * radius_m +
         kValueRounding * eye_m;
}

// The rounding of the matrix and of the eye counts once for the middle and once for the step, which
// a turn of less than half a radian derives from them.
double Stretch::bend_m(double radius_m) const {
  const double eye_m = eye_W.norm() + radius_m;
  const double step_m = eye_step_W.norm() + radius_m * turn_step_W.norm();
  return (travel_bend_m + travel_rounding_m + radius_m * turn_bend) * kRoundUp +
         2.0 * (kMatrixRounding * radius_m + kValueRounding * eye_m) + kStepRounding * step_m;
}

double Stretch::rounding_m(double radius_m) const {
  const double eye_m = eye_W.norm() + radius_m;
  return reach_of(travel_rounding_m, turn_rounding_sine, radius_m) + kMatrixRounding * radius_m +
         kValueRounding * eye_m;
}

Stretch standing_at(const Pose& pose) {
  Stretch stretch;
  stretch.eye_W = pose.position;
  stretch.R_WC = pose.orientation.toRotationMatrix();
  return stretch;
}

SegmentMotion::SegmentMotion(const Segment& segment)
    : position_(series_about_middle(segment.position)),
      orientation_(series_about_middle(segment.orientation)),
      first_position_(segment.position[0]),
      first_orientation_(segment.orientation[0]),
      position_rounding_m_(kPositionSeriesRounding * largest_difference(segment.position)),
      orientation_rounding_(kOrientationSeriesRounding * largest_difference(segment.orientation)) {}

Stretch SegmentMotion::around(double u0, double u1) const {
  const double middle = 0.5 * (u0 + u1);
  const double half_width = std::max(u1 - middle, middle - u0) * kRoundUp;
  std::array<Vec3, 4> position = position_;
  std::array<Vec4, 7> orientation = orientation_;
  shift_series(position, middle - 0.5);
  shift_series(orientation, middle - 0.5);

  Stretch stretch;
  stretch.eye_W = first_position_ + position[0];
  const double travel_bend_m =
      half_width * half_width * (position[2].norm() + half_width * position[3].norm());
  stretch.travel_m = half_width * position[1].norm() + travel_bend_m;
  stretch.travel_rounding_m = position_rounding_m_;
  stretch.eye_step_W = half_width * position[1];
  stretch.travel_bend_m = travel_bend_m;
  turn_around(stretch, orientation, half_width);
  return stretch;
}

/// The part of `around` for the turn. `series`: about the middle of the stretch.
void SegmentMotion::turn_around(Stretch& stretch, const std::array<Vec4, 7>& series,
                                double half_width) const {
  const Vec4 q = first_orientation_ + series[0];
  const double squared_length = q.squaredNorm();
  const double length = std::sqrt(squared_length);
  const double rounding = orientation_rounding_ + kValueRounding * length;
  // Below twice the rounding the direction means nothing; "not a number" also returns here.
  if (!(length > 2.0 * rounding) || !(squared_length > std::numeric_limits<double>::min())) {
    stretch.R_WC.setIdentity();
    stretch.turn_sine = stretch.turn_rounding_sine = 1.0;
    go_nowhere(stretch);
    return;
  }
  stretch.R_WC = rotation_of(q, squared_length);
  const Vec4 direction = q / length;
  double along = 0.0;
  double across = 0.0;
  double across_bend = 0.0;  // of all powers but the first
  for (std::size_t k = series.size() - 1; k > 0; --k) {
    const double part = series[k].dot(direction);
    across_bend = half_width * across;
    across = half_width * (across + (series[k] - part * direction).norm());
    along = half_width * (along + std::abs(part));
  }
  stretch.turn_sine = sine_of(across + rounding, length - along - rounding);
  stretch.turn_rounding_sine = sine_of(rounding, length - rounding);
  const double tangent = (across + rounding) / (length - along - rounding) * kRoundUp;
  // In this order "not a number" and turns of a right angle or more return here.
  if (!(tangent >= 0.0 && tangent < kLargestTangent)) {
    go_nowhere(stretch);
    return;
  }
  stretch.turn_step_W = (2.0 * half_width / length) * vector_part(series[1], direction);
  const double tangent_bend = (across_bend + rounding + tangent * (along + rounding)) / length;
  stretch.turn_bend = 2.0 * (tangent_bend + tangent * tangent * (1.0 + tangent)) * kRoundUp;
}

}  // namespace camway::motion
