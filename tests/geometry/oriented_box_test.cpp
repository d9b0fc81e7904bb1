// SPDX-License-Identifier: MIT
#include "daemon/geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "daemon/geometry/triangle_distance.h"
#include "tests/geometry/random_triangles.h"

namespace camway::geometry {
namespace {

double scale_of(std::span<const Triangle> body, const Triangle& other) {
  Box box = bounds(other);
  for (const Triangle& part : body) box.extend(bounds(part));
  return box.sizes().maxCoeff();
}

void expect_bound(const std::vector<Triangle>& body, const Triangle& other) {
  double least_m = triangle_distance(body[0], other);
  for (const Triangle& part : body) least_m = std::min(least_m, triangle_distance(part, other));
  // The bound's own error, and that of the distance it is compared with.
  const double limit_m = least_m + 2.0 * triangle_distance_error_m(scale_of(body, other));
  ASSERT_LE(OrientedBox(body).squared_distance_bound_m2(other),
            limit_m * limit_m * (1.0 + OrientedBox::kRelativeError))
      << to_text(body[0]) << to_text(other);
}

TEST(OrientedBox, NeverExceedsTheDistance) {
  RandomTriangles random(541);
  for (int i = 0; i < 40'000; ++i) {
    const auto [a, b] = random.close_pair();
    const Vec3 shift = i % 3 == 0 ? Vec3(1e6 * random.in_cube(1.0)) : Vec3(0, 0, 0);
    std::vector<Triangle> body = {moved(a, shift)};
    if (i % 2 == 0) body.push_back(moved(random.thin_triangle(), shift));
    expect_bound(body, moved(b, shift));
    if (HasFatalFailure()) return;
  }
}

TEST(OrientedBox, NeverExceedsTheDistanceAtAnySize) {
  RandomTriangles random(542);
  for (int i = 0; i < 20'000; ++i) {
    const double size = random.log_uniform(1e-59, 1e59);
    auto [a, b] = random.close_pair();
    for (Vec3& v : a) v *= size;
    for (Vec3& v : b) v *= size;
    expect_bound({a}, b);
    if (HasFatalFailure()) return;
  }
}

TEST(OrientedBox, IsExactForAQuadrilateralAndWhatFacesIt) {
  RandomTriangles random(543);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 e = random.log_uniform(0.1, 10.0) * random.in_cube(1.0).normalized();
    const Vec3 f = e.cross(random.in_cube(1.0).normalized());
    const Vec3 p = random.in_cube(10.0);
    const std::vector<Triangle> quad = {{p, p + e, p + e + f}, {p, p + e + f, p + f}};
    const Vec3 normal = e.cross(f).normalized();
    const double distance_m = random.log_uniform(1e-3, 10.0);
    // Parallel to the face, above its centre.
    const Vec3 q = p + 0.5 * (e + f) + distance_m * normal;
    const Triangle other = {q, q + 0.1 * e, q + 0.1 * f};
    const double bound_m = std::sqrt(OrientedBox(quad).squared_distance_bound_m2(other));
    // The corners of the quadrilateral are rounded, too.
    const double error_m = 2.0 * triangle_distance_error_m(scale_of(quad, other) + 10.0);
    EXPECT_NEAR(bound_m, distance_m, error_m);
  }
}

TEST(OrientedBox, BoundsTwoPartsBitForBitAsOneByOne) {
  RandomTriangles random(544);
  int excluded = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto [a, other] = random.close_pair();
    Triangle b = random.thin_triangle();
    // Halves of a quadrilateral begin at the same corner, and so have their origin in common.
    if (i % 2 == 0) b = {a[0], a[2], Vec3(a[0] + a[2] - a[1])};
    if (i % 4 != 0) other = moved(other, 10.0 * random.in_cube(1.0));
    if (i % 50 == 0) other[2] = other[1];  // has no plane
    const Vec3 shift = i % 3 == 0 ? Vec3(1e6 * random.in_cube(1.0)) : Vec3(0, 0, 0);
    const std::array<Triangle, 2> body = {moved(a, shift), moved(b, shift)};
    other = moved(other, shift);
    const OrientedBox whole(body);
    const std::array<OrientedBox, 2> parts = {whole.around({&body[0], 1}),
                                              whole.around({&body[1], 1})};
    const double plane_m2 = whole.plane_bound_m2(other);
    const double most_m2 = i % 5 == 0 ? plane_m2 : plane_m2 * random.uniform(0.0, 2.0);
    OrientedBox::TwoBounds bounds;
    ASSERT_EQ(whole.bound_two(parts, other, most_m2, bounds), !(plane_m2 > most_m2));
    if (plane_m2 > most_m2) {
      ++excluded;
      continue;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_EQ(bounds.axes_m2[k], parts[k].axes_bound_m2(other)) << to_text(other);
      ASSERT_EQ(bounds.plane_m2[k], parts[k].plane_bound_m2(other)) << to_text(other);
    }
  }
  EXPECT_GT(excluded, 1000);
  EXPECT_LT(excluded, 10'000);
}

}  // namespace
}  // namespace camway::geometry
