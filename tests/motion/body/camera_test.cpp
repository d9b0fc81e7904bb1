// SPDX-License-Identifier: MIT
#include "daemon/motion/body/camera.h"

#include <numbers>

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using test::Vec3;
using testing::Random;

TEST(Camera, CornersOfARightAngleCamera) {
  const Corners corners = near_corners_C({std::numbers::pi / 2.0, std::numbers::pi / 3.0, 0.3});
  const double y = 0.3 / std::sqrt(3.0);
  const std::array<Vec3, 4> expected = {Vec3(0.3, y, -0.3), Vec3(-0.3, y, -0.3),
                                        Vec3(-0.3, -y, -0.3), Vec3(0.3, -y, -0.3)};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((corners[i] - expected[i]).norm(), 4.0 * kEpsilon) << "corner " << i;
}

TEST(Camera, NeighboursInTheArrayShareAnEdge) {
  const Corners corners = near_corners_C({1.9, 0.7, 0.05});
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 edge = corners[(i + 1) % 4] - corners[i];
    EXPECT_EQ((edge.array() != 0.0).count(), 1) << "edge " << i << " is parallel to an axis";
  }
}

TEST(Camera, CornersFollowThePose) {
  Random random(31);
  for (int i = 0; i < 100; ++i) {
    const Corners corners_C = near_corners_C({1.2, 0.9, 0.1});
    const Pose pose{random.normal_vector(5.0), random.rotation()};
    const Corners corners = corners_W(corners_C, pose);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 expected = pose.orientation * corners_C[k] + pose.position;
      EXPECT_LT((corners[k] - expected).norm(), 8.0 * kEpsilon * (pose.position.norm() + 1.0));
    }
  }
}

TEST(Camera, LooksDownMinusZ) {
  const Pose pose{Vec3(1.0, 2.0, 3.0), geometry::Quat::Identity()};
  for (const Vec3& corner : corners_W(near_corners_C({1.0, 1.0, 0.25}), pose))
    EXPECT_DOUBLE_EQ(corner.z(), 2.75);
}

TEST(Camera, RadiusIsTheFarthestCorner) {
  const Corners corners_C = {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, -3), Vec3(1, 1, 1)};
  EXPECT_EQ(body_radius_m(corners_C), 3.0);
}

}  // namespace
}  // namespace camway::motion
