// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "daemon/motion/path/segment.h"

/// The oracle of rounding: the formulas of a segment, evaluated with 50 digits.
namespace camway::motion::test {

using Real = boost::multiprecision::cpp_bin_float_50;

template <class Vector, std::size_t N>
std::vector<Real> exact_value_at(const std::array<Vector, N>& points, double u) {
  std::vector<std::vector<Real>> c;
  for (const Vector& point : points) c.emplace_back(point.begin(), point.end());
  for (std::size_t count = N; count > 1; --count) {
    for (std::size_t i = 0; i + 1 < count; ++i) {
      for (std::size_t k = 0; k < c[i].size(); ++k) {
        c[i][k] = (Real(1) - Real(u)) * c[i][k] + Real(u) * c[i + 1][k];
      }
    }
  }
  return c[0];
}

/// Returns `v` rotated by a quaternion of any length: (q v q*) / |q|².
inline std::vector<Real> exact_rotated(const std::vector<Real>& q, const geometry::Vec3& v) {
  const Real w = q[0], x = q[1], y = q[2], z = q[3];
  const Real a = v.x(), b = v.y(), c = v.z();
  const Real squared = w * w + x * x + y * y + z * z;
  return {
      ((w * w + x * x - y * y - z * z) * a + 2 * (x * y - w * z) * b + 2 * (x * z + w * y) * c) /
          squared,
      (2 * (x * y + w * z) * a + (w * w - x * x + y * y - z * z) * b + 2 * (y * z - w * x) * c) /
          squared,
      (2 * (x * z - w * y) * a + 2 * (y * z + w * x) * b + (w * w - x * x - y * y + z * z) * c) /
          squared};
}

/// Returns the distance of `computed_W` from the body's point at `u` by the segment's numbers.
inline double distance_from_exact_m(const Segment& segment, double u, const geometry::Vec3& point_C,
                                    const geometry::Vec3& computed_W) {
  const std::vector<Real> eye = exact_value_at(segment.position, u);
  const std::vector<Real> arm = exact_rotated(exact_value_at(segment.orientation, u), point_C);
  Real squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Real difference = eye[k] + arm[k] - Real(computed_W[static_cast<Eigen::Index>(k)]);
    squared += difference * difference;
  }
  return static_cast<double>(sqrt(squared));
}

}  // namespace camway::motion::test
