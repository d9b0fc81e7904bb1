// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

/// Coordinates as integers: doubles are multiples of a power of two, so sums and products of them
/// are exact. For the kernels that decide what rounding leaves open.
/// Thread-safe.
namespace camway::geometry {

using Integer = boost::multiprecision::cpp_int;
using IntegerVec = std::array<Integer, 3>;

/// Returns the exponent of the lowest bit that can be set in a non-zero, finite `x`.
inline int lowest_exponent(double x) {
  return std::ilogb(x) + 1 - std::numeric_limits<double>::digits;
}

/// Returns `x / 2^unit_exponent`. Requires a quotient that is an integer.
inline Integer to_integer(double x, int unit_exponent) {
  if (x == 0.0) return 0;
  const int exponent = lowest_exponent(x);
  return Integer(static_cast<std::int64_t>(std::ldexp(x, -exponent))) << (exponent - unit_exponent);
}

inline IntegerVec difference(const IntegerVec& a, const IntegerVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline IntegerVec cross(const IntegerVec& a, const IntegerVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool is_zero(const IntegerVec& v) {
  return v[0].is_zero() && v[1].is_zero() && v[2].is_zero();
}

}  // namespace camway::geometry
