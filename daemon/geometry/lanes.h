// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "daemon/geometry/types.h"

// GCC warns that the calling convention of such vectors by value depends on the processor. All
// functions here are inlined, so there are no calls; nor in the sources that include this.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Arithmetic on three vectors at a time, such as the corners or the edges of a triangle. For use
/// in functions marked CAMWAY_FOR_EVERY_PROCESSOR.
namespace camway::geometry::lanes {

/// A vector type of GCC and Clang, compiled to the instructions of the processor. Lane 3 repeats
/// lane 0.
using Numbers = double __attribute__((vector_size(32)));
inline constexpr std::size_t kLanes = 3;

/// Three vectors, coordinate by coordinate.
struct Vectors {
  Numbers x, y, z;
};

#define CAMWAY_INLINE [[gnu::always_inline]] inline

CAMWAY_INLINE Vectors load(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {Numbers{a[0], b[0], c[0], a[0]}, Numbers{a[1], b[1], c[1], a[1]},
          Numbers{a[2], b[2], c[2], a[2]}};
}
CAMWAY_INLINE Vectors load(const Triangle& t) { return load(t[0], t[1], t[2]); }
/// `v` in every lane.
CAMWAY_INLINE Vectors repeat(const Vec3& v) {
  return {Numbers{v[0], v[0], v[0], v[0]}, Numbers{v[1], v[1], v[1], v[1]},
          Numbers{v[2], v[2], v[2], v[2]}};
}
CAMWAY_INLINE Vec3 get(const Vectors& v, std::size_t lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}
/// Lane `lane` in every lane.
CAMWAY_INLINE Vectors repeat(const Vectors& v, std::size_t lane) { return repeat(get(v, lane)); }
/// Lane i holds lane i + 1 of `v`, so `rotated(t) - t` are the edges of `t`.
CAMWAY_INLINE Vectors rotated(const Vectors& v) {
  return {__builtin_shufflevector(v.x, v.x, 1, 2, 0, 1),
          __builtin_shufflevector(v.y, v.y, 1, 2, 0, 1),
          __builtin_shufflevector(v.z, v.z, 1, 2, 0, 1)};
}

CAMWAY_INLINE Vectors operator+(const Vectors& a, const Vectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
CAMWAY_INLINE Vectors operator-(const Vectors& a, const Vectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
CAMWAY_INLINE Vectors operator-(const Vectors& v) { return {-v.x, -v.y, -v.z}; }
CAMWAY_INLINE Vectors operator*(const Numbers& s, const Vectors& v) {
  return {s * v.x, s * v.y, s * v.z};
}
CAMWAY_INLINE Numbers dot(const Vectors& a, const Vectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
CAMWAY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
CAMWAY_INLINE Vectors operator*(double s, const Vectors& v) { return {s * v.x, s * v.y, s * v.z}; }
CAMWAY_INLINE Numbers magnitude(const Numbers& x) { return x < 0.0 ? -x : x; }
/// The lesser in each lane; `b` where either is NaN.
CAMWAY_INLINE Numbers smaller(const Numbers& a, const Numbers& b) { return a < b ? a : b; }
/// The greater in each lane; `b` where either is NaN.
CAMWAY_INLINE Numbers larger(const Numbers& a, const Numbers& b) { return a > b ? a : b; }

/// The largest magnitude of a coordinate.
CAMWAY_INLINE double largest_coordinate(const Vectors& v) {
  const Numbers most = larger(larger(magnitude(v.x), magnitude(v.y)), magnitude(v.z));
  const double first = most[0] > most[1] ? most[0] : most[1];
  return first > most[2] ? first : most[2];
}
CAMWAY_INLINE Numbers squared_norm(const Vectors& v) { return dot(v, v); }

/// `numerator / denominator` clamped to [0, 1]; 0 if the quotient is not a number.
CAMWAY_INLINE Numbers unit_quotient(const Numbers& numerator, const Numbers& denominator) {
  const Numbers zero = {};
  const Numbers one = {1.0, 1.0, 1.0, 1.0};
  const Numbers x = numerator / denominator;
  return x > zero ? (x < one ? x : one) : zero;
}

#undef CAMWAY_INLINE

}  // namespace camway::geometry::lanes
