// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "daemon/motion/path/segment.h"

/// The continuity of a path for its receiver, computed in long double from the control points and
/// the differences of times as sent. Shares no code with the implementation.
namespace camway::testing {

/// The largest jumps at the joins of a path, as multiples of the allowed ones. Up to 1 the path is
/// C².
struct Jumps {
  double value = 0.0;
  double first = 0.0;   ///< jump of the first derivative with respect to time
  double second = 0.0;  ///< jump of the second derivative with respect to time

  [[nodiscard]] double largest() const { return std::max({value, first, second}); }
};

namespace continuity {

template <std::size_t N>
using Row = std::array<long double, N>;

template <std::size_t N>
Row<N> sum(const Row<N>& a, long double factor, const Row<N>& b) {
  Row<N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = a[i] + factor * b[i];
  return result;
}
template <std::size_t N>
long double dot(const Row<N>& a, const Row<N>& b) {
  long double result = 0.0L;
  for (std::size_t i = 0; i < N; ++i) result += a[i] * b[i];
  return result;
}
template <std::size_t N>
long double length(const Row<N>& a) {
  return std::sqrt(dot(a, a));
}

/// Value and two derivatives at an end of a Bézier curve, and the error of each if every control
/// point is rounded by one unit.
template <std::size_t N>
struct End {
  std::array<Row<N>, 3> derivatives;
  std::array<long double, 3> rounding;
};

template <std::size_t N, class Points>
End<N> end_of(const Points& points, long double duration_s, bool at_begin) {
  const auto row = [&](std::size_t steps) {
    const auto& point = points[at_begin ? steps : points.size() - 1 - steps];
    Row<N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = point[static_cast<Eigen::Index>(i)];
    return result;
  };
  const long double degree = static_cast<long double>(points.size()) - 1.0L;
  const long double sign = at_begin ? 1.0L : -1.0L;
  const long double rate = degree / duration_s;
  const long double curving = rate * (degree - 1.0L) / duration_s;
  long double size = 0.0L;
  for (const auto& point : points) size = std::max<long double>(size, point.norm());
  const long double unit = std::numeric_limits<double>::epsilon() / 2.0L * size;
  Row<N> zero{};
  return {{row(0), sum(zero, sign * rate, sum(row(1), -1.0L, row(0))),
           sum(zero, curving, sum(sum(row(2), -2.0L, row(1)), 1.0L, row(0)))},
          {unit, 2.0L * rate * unit, 4.0L * curving * unit}};
}

/// Returns value and derivatives of the curve divided by its length.
inline End<4> normalised(const End<4>& end) {
  const auto& [n, n1, n2] = end.derivatives;
  const long double size = length(n);
  Row<4> zero{};
  const Row<4> q = sum(zero, 1.0L / size, n);
  const long double size1 = dot(q, n1);
  const Row<4> q1 = sum(zero, 1.0L / size, sum(n1, -size1, q));
  const long double size2 = dot(q1, n1) + dot(q, n2);
  const Row<4> q2 = sum(zero, 1.0L / size, sum(sum(n2, -size2, q), -2.0L * size1, q1));
  End<4> result{{q, q1, q2}, {}};
  for (std::size_t i = 0; i < 3; ++i) result.rounding[i] = end.rounding[i] / size;
  return result;
}

/// Allowed jump relative to the larger side. The rounding of parameters causes jumps of this order.
constexpr long double kShare = 1e-9L;
/// Number of roundings in a control point, which some tens of operations make.
constexpr long double kRoundings = 64.0L;

template <std::size_t N>
void raise(Jumps& jumps, const End<N>& before, const End<N>& after) {
  double* const largest[] = {&jumps.value, &jumps.first, &jumps.second};
  for (std::size_t i = 0; i < 3; ++i) {
    const long double jump = length(sum(before.derivatives[i], -1.0L, after.derivatives[i]));
    const long double size = std::max(length(before.derivatives[i]), length(after.derivatives[i]));
    const long double allowed =
        kShare * size + kRoundings * std::max(before.rounding[i], after.rounding[i]);
    // The comparison is negated so that NaN counts as a jump.
    const double ratio = static_cast<double>(jump / allowed);
    if (jump > 0.0L && !(ratio <= *largest[i])) *largest[i] = ratio;
  }
}

}  // namespace continuity

inline Jumps jumps_of(std::span<const motion::Segment> segments) {
  using namespace continuity;
  Jumps jumps;
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    const motion::Segment& before = segments[i];
    const motion::Segment& after = segments[i + 1];
    if (before.t1_s != after.t0_s) return {INFINITY, INFINITY, INFINITY};
    const long double last_s = static_cast<long double>(before.t1_s) - before.t0_s;
    const long double next_s = static_cast<long double>(after.t1_s) - after.t0_s;
    raise(jumps, end_of<3>(before.position, last_s, false),
          end_of<3>(after.position, next_s, true));
    raise(jumps, normalised(end_of<4>(before.orientation, last_s, false)),
          normalised(end_of<4>(after.orientation, next_s, true)));
  }
  return jumps;
}

/// Returns the duration of the shortest segment.
inline double shortest_s(std::span<const motion::Segment> segments) {
  double shortest_s = INFINITY;
  for (const motion::Segment& segment : segments)
    shortest_s = std::min(shortest_s, segment.t1_s - segment.t0_s);
  return shortest_s;
}

}  // namespace camway::testing
