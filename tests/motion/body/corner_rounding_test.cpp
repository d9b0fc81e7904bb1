// SPDX-License-Identifier: MIT
#include "daemon/motion/body/corner_rounding.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/motion/fifty_digits.h"
#include "tests/motion/random_motion.h"

namespace camway::motion::test {
namespace {

// From a camera of a millimetre to one of ten metres, from the origin to 1e6 m away, with
// orientation control points that nearly cancel.
TEST(CornerRounding, HoldsAgainstFiftyDigits) {
  Random random(20260);
  double worst = 0.0;
  for (int run = 0; run < 5'000; ++run) {
    const double place_m = random.log_uniform(1e-3, 1e6);
    const double size_m = random.log_uniform(1e-3, 10.0);
    Segment segment{0.0, 1.0, {}, {}};
    for (Vec3& point : segment.position) point = random.normal_vector(place_m);
    const double spread = random.log_uniform(1e-6, 3.0);
    const Vec4 about = geometry::wxyz(random.rotation());
    for (Vec4& point : segment.orientation)
      point = about + spread * geometry::wxyz(random.rotation());
    const Corners corners_C =
        near_corners_C({random.uniform(0.2, 2.5), random.uniform(0.2, 2.5), size_m});
    const double u = random.uniform(0.0, 1.0);
    const double bound_m = corner_rounding_m(segment, u, body_radius_m(corners_C));
    const Corners computed_W = corners_W(corners_C, pose_at(segment, u));
    for (std::size_t i = 0; i < 4; ++i) {
      const double error_m = distance_from_exact_m(segment, u, corners_C[i], computed_W[i]);
      ASSERT_LE(error_m, bound_m) << "run " << run;
      worst = std::max(worst, error_m / bound_m);
    }
  }
  std::printf("worst share of the bound: %.3f\n", worst);
  // A bound that is a hundred times too large would be useless.
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
