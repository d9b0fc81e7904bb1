// SPDX-License-Identifier: MIT
#include "tests/geometry/exact_oracle.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace camway::geometry::oracle {
namespace {

using V = std::array<Rational, 3>;

V vec(const Vec3& v) { return {Rational(v.x()), Rational(v.y()), Rational(v.z())}; }
V sub(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V add(const V& a, const Rational& s, const V& d) {
  return {a[0] + s * d[0], a[1] + s * d[1], a[2] + s * d[2]};
}
Rational dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational length2(const V& a) { return dot(a, a); }
bool in_unit(const Rational& x) { return x >= 0 && x <= 1; }

Rational point_segment(const V& p, const V& a, const V& b) {
  const V e = sub(b, a);
  const Rational e2 = length2(e);
  Rational s = 0;
  if (e2 != 0) s = std::clamp<Rational>(dot(sub(p, a), e) / e2, 0, 1);
  return length2(sub(p, add(a, s, e)));
}

/// Returns the squared distance of the lines if the feet are within both segments.
std::optional<Rational> inner_segment_segment(const V& p, const V& e, const V& q, const V& f) {
  const V w = sub(q, p);
  const Rational ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), ew = dot(e, w), fw = dot(f, w);
  const Rational det = ee * ff - ef * ef;
  if (det == 0) return std::nullopt;
  const Rational s = (ew * ff - ef * fw) / det;
  const Rational t = (ef * ew - ee * fw) / det;
  if (!in_unit(s) || !in_unit(t)) return std::nullopt;
  return length2(sub(add(q, t, f), add(p, s, e)));
}

/// Returns the squared distance from the plane if the foot is within the triangle.
std::optional<Rational> inner_point_face(const V& p, const std::array<V, 3>& t) {
  const V n = cross(sub(t[1], t[0]), sub(t[2], t[0]));
  const Rational n2 = length2(n);
  if (n2 == 0) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const V& a = t[i];
    const V& b = t[(i + 1) % 3];
    if (dot(cross(n, sub(b, a)), sub(p, a)) < 0) return std::nullopt;
  }
  const Rational h = dot(n, sub(p, t[0]));
  return h * h / n2;
}

bool segment_pierces(const V& p, const V& q, const std::array<V, 3>& t) {
  const V n = cross(sub(t[1], t[0]), sub(t[2], t[0]));
  const V d = sub(q, p);
  const Rational slope = dot(n, d);
  if (slope == 0) return false;
  const Rational s = dot(n, sub(t[0], p)) / slope;
  return in_unit(s) && inner_point_face(add(p, s, d), t).has_value();
}

}  // namespace

Rational squared_distance(const Triangle& ta, const Triangle& tb) {
  const std::array<V, 3> a = {vec(ta[0]), vec(ta[1]), vec(ta[2])};
  const std::array<V, 3> b = {vec(tb[0]), vec(tb[1]), vec(tb[2])};
  Rational best = length2(sub(a[0], b[0]));
  const auto consider = [&](const Rational& d2) { best = std::min(best, d2); };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t in = (i + 1) % 3;
    if (segment_pierces(a[i], a[in], b) || segment_pierces(b[i], b[in], a)) return 0;
    if (const auto d2 = inner_point_face(a[i], b)) consider(*d2);
    if (const auto d2 = inner_point_face(b[i], a)) consider(*d2);
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t jn = (j + 1) % 3;
      consider(point_segment(a[i], b[j], b[jn]));
      consider(point_segment(b[i], a[j], a[jn]));
      if (const auto d2 = inner_segment_segment(a[i], sub(a[in], a[i]), b[j], sub(b[jn], b[j]))) {
        consider(*d2);
      }
    }
  }
  return best;
}

bool touches_box(const Triangle& triangle, const Box& box) {
  // Clips the triangle by the six half-spaces (Sutherland & Hodgman); the rest is the intersection.
  std::vector<V> polygon = {vec(triangle[0]), vec(triangle[1]), vec(triangle[2])};
  for (int side = 0; side < 6 && !polygon.empty(); ++side) {
    const auto k = static_cast<std::size_t>(side / 2);
    const bool low = side % 2 == 0;
    const Rational bound(low ? box.min()[side / 2] : box.max()[side / 2]);
    const auto inside = [&](const V& v) { return low ? v[k] >= bound : v[k] <= bound; };
    std::vector<V> rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const V& p = polygon[i];
      const V& q = polygon[(i + 1) % polygon.size()];
      if (inside(p)) rest.push_back(p);
      if (inside(p) != inside(q)) {
        rest.push_back(add(p, (bound - p[k]) / (q[k] - p[k]), sub(q, p)));
      }
    }
    polygon = std::move(rest);
  }
  return !polygon.empty();
}

double distance_m(const Triangle& a, const Triangle& b) {
  // Scaled by a power of 4, so that the square of a tiny distance does not underflow.
  const Rational squared = squared_distance(a, b);
  if (squared == 0) return 0.0;
  const auto numerator_bits = static_cast<int>(msb(numerator(squared)));
  const auto denominator_bits = static_cast<int>(msb(denominator(squared)));
  const int half = (denominator_bits - numerator_bits) / 2;
  Rational scaled = squared;
  if (half > 0) scaled *= Rational(boost::multiprecision::cpp_int(1) << (2 * half));
  if (half < 0) scaled /= Rational(boost::multiprecision::cpp_int(1) << (-2 * half));
  return std::ldexp(std::sqrt(scaled.convert_to<double>()), -half);
}

}  // namespace camway::geometry::oracle
