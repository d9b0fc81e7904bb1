// SPDX-License-Identifier: MIT
#include "daemon/geometry/exact_orientation.h"

#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

using Rational = boost::multiprecision::cpp_rational;  // made of a double without rounding

int sign(double x) { return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0); }

Rational difference(double x, double y) { return Rational(x) - Rational(y); }

int exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Rational left = difference(b.x(), a.x()) * difference(c.y(), a.y());
  const Rational right = difference(b.y(), a.y()) * difference(c.x(), a.x());
  return left.compare(right);
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const auto from_a = [&](const Vec3& v) {
    return std::array<Rational, 3>{difference(v.x(), a.x()), difference(v.y(), a.y()),
                                   difference(v.z(), a.z())};
  };
  const std::array<Rational, 3> e = from_a(b);
  const std::array<Rational, 3> f = from_a(c);
  const std::array<Rational, 3> g = from_a(p);
  const Rational x = e[1] * f[2] - e[2] * f[1];
  const Rational y = e[2] * f[0] - e[0] * f[2];
  const Rational z = e[0] * f[1] - e[1] * f[0];
  const Rational volume = x * g[0] + y * g[1] + z * g[2];
  return volume.sign();
}

}  // namespace

// Each product carries its own rounding and those of its two differences, 3u, and the last
// subtraction u of the result: below 4u of the sum of the magnitudes, with the second order.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y());
  const double right = (b.y() - a.y()) * (c.x() - a.x());
  const double area = left - right;
  const double error = 5.0 * kUnitRoundoff * (std::abs(left) + std::abs(right)) + kSmallestNormal;
  return std::abs(area) > error ? sign(area) : exact_orientation(a, b, c);
}

// A minor carries 3u of the magnitudes of its products and u of itself, its product with the third
// difference 2u more, the two sums 2u: 8u of the permanent to first order, 10u leave room for the
// second. An underflow in a minor grows by that third difference.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 e = b - a;
  const Vec3 f = c - a;
  const Vec3 g = p - a;
  const double volume = e.cross(f).dot(g);
  const Vec3 e_size = e.cwiseAbs();
  const Vec3 f_size = f.cwiseAbs();
  const Vec3 minors(e_size.y() * f_size.z() + e_size.z() * f_size.y(),
                    e_size.z() * f_size.x() + e_size.x() * f_size.z(),
                    e_size.x() * f_size.y() + e_size.y() * f_size.x());
  const double error =
      10.0 * kUnitRoundoff * minors.dot(g.cwiseAbs()) + kSmallestNormal * (1.0 + g.lpNorm<1>());
  return std::abs(volume) > error ? sign(volume) : exact_orientation(a, b, c, p);
}

}  // namespace camway::geometry
