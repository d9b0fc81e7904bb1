// SPDX-License-Identifier: MIT
#include "daemon/motion/corner_rounding.h"

#include <gtest/gtest.h>

#include <cstdio>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "tests/motion/random_motion.h"

namespace camway::motion::test {
namespace {

// The oracle: the same formulas with 50 digits on the very numbers of the segment.
using Real = boost::multiprecision::cpp_bin_float_50;

template <class Vector, std::size_t N>
std::vector<Real> value_at(const std::array<Vector, N>& points, double u) {
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

// Rotation by a quaternion of any length: (q v q*) / |q|².
std::vector<Real> rotated(const std::vector<Real>& q, const Vec3& v) {
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

double exact_error_m(const Segment& segment, double u, const Vec3& corner_C,
                     const Vec3& computed_W) {
  const std::vector<Real> eye = value_at(segment.position, u);
  const std::vector<Real> arm = rotated(value_at(segment.orientation, u), corner_C);
  Real squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Real difference = eye[k] + arm[k] - Real(computed_W[static_cast<Eigen::Index>(k)]);
    squared += difference * difference;
  }
  return static_cast<double>(sqrt(squared));
}

// From a camera of a millimetre to one of ten metres, from the origin to 1e6 m away, with
// orientation control points that nearly cancel.
TEST(CornerRounding, HoldsAgainstFiftyDigits) {
  Random random(20260);
  double worst = 0.0;
  for (int run = 0; run < 5'000; ++run) {
    const double place_m = random.log_uniform(1e-3, 1e6);
    const double size_m = random.log_uniform(1e-3, 10.0);
    Segment segment{0.0, 1.0, {}, {}};
    for (Vec3& point : segment.position) point = random.vector(place_m);
    const double spread = random.log_uniform(1e-6, 3.0);
    const Vec4 about = random.unit_four_vector();
    for (Vec4& point : segment.orientation) point = about + spread * random.unit_four_vector();
    const Corners corners_C =
        near_corners_C({random.uniform(0.2, 2.5), random.uniform(0.2, 2.5), size_m});
    const double u = random.uniform(0.0, 1.0);
    const double bound_m = corner_rounding_m(segment, u, body_radius_m(corners_C));
    const Corners computed_W = corners_W(corners_C, pose_at(segment, u));
    for (std::size_t i = 0; i < 4; ++i) {
      const double error_m = exact_error_m(segment, u, corners_C[i], computed_W[i]);
      ASSERT_LE(error_m, bound_m) << "run " << run;
      worst = std::max(worst, error_m / bound_m);
    }
  }
  std::printf("worst share of the bound: %.3f\n", worst);
  // A bound a hundred times too large would be of no use either.
  EXPECT_GT(worst, 0.01);
}

TEST(CornerRounding, IsInfiniteWhereTheOrientationVanishes) {
  Segment segment{0.0, 1.0, {}, {}};
  for (Vec3& point : segment.position) point.setZero();
  segment.orientation.fill(Vec4::Zero());
  EXPECT_TRUE(std::isinf(corner_rounding_m(segment, 0.5, 1.0)));
}

}  // namespace
}  // namespace camway::motion::test
