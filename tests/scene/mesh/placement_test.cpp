// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/geometry/random_triangles.h"
#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::RandomTriangles;
using geometry::Vec3;
using ::testing::HasSubstr;

using Real = long double;
using RealVec3 = Eigen::Matrix<Real, 3, 1>;
using RealMat3 = Eigen::Matrix<Real, 3, 3>;

Quat random_orientation(RandomTriangles& random) {
  const double length = random.log_uniform(1e-3, 1e3);
  return {length * random.uniform(-1, 1), length * random.uniform(-1, 1),
          length * random.uniform(-1, 1), length * random.uniform(-1, 1)};
}

/// The rotation of `q` in extended precision.
RealMat3 exact_rotation(const Quat& q) { return q.cast<Real>().normalized().toRotationMatrix(); }

Placement placement_of(const Vec3& position, const Quat& orientation) {
  std::string fault;
  Placement placement = Placement::make(position, orientation, fault);
  EXPECT_EQ(fault, "");
  return placement;
}

TEST(Placement, RoundsByNoMoreThanItsBoundBothWays) {
  RandomTriangles random(1101);
  double worst = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const Quat orientation = random_orientation(random);
    const Vec3 position = random.in_cube(random.log_uniform(1e-6, 1e6));
    const Vec3 point = random.in_cube(random.log_uniform(1e-6, 1e6));
    const Placement placement = placement_of(position, orientation);
    const RealMat3 R = exact_rotation(orientation);
    const RealVec3 there = R * point.cast<Real>() + position.cast<Real>();
    const RealVec3 back = R.transpose() * (point.cast<Real>() - position.cast<Real>());
    const double bound_m = placement.error_m(point.lpNorm<1>());
    const auto off = [&](const Vec3& rounded, const RealVec3& exact) {
      return static_cast<double>((rounded.cast<Real>() - exact).norm()) / bound_m;
    };
    worst = std::max(
        {worst, off(placement.to_world(point), there), off(placement.to_object(point), back)});
    ASSERT_LE(worst, 1.0);
  }
  std::printf("largest error: %.3f of the bound\n", worst);
}

TEST(Placement, LeavesCoordinatesAloneWhereItIsTheWorldsFrame) {
  const Mesh mesh = mesh_of_triangles({{Vec3(0.1, 1e-300, 3), Vec3(1, 0.7, 0), Vec3(0, 0, 1)}});
  for (const Placement& placement : {Placement(), placement_of(Vec3::Zero(), Quat(3, 0, 0, 0)),
                                     placement_of(Vec3::Zero(), Quat(-1, 0, 0, 0))}) {
    EXPECT_TRUE(placement.is_identity());
    EXPECT_EQ(placement.error_m(1e9), 0.0);
    EXPECT_EQ(placed_mesh(mesh, placement).vertices, mesh.vertices);
  }
  EXPECT_FALSE(placement_of(Vec3(0, 0, 1e-300), Quat::Identity()).is_identity());
}

TEST(Placement, TurnsAsQuaternionsDo) {
  const double h = std::sqrt(0.5);
  const Placement placement = placement_of(Vec3(10, 0, 0), Quat(h, 0, 0, h));  // a quarter about z
  EXPECT_TRUE(placement.to_world(Vec3(1, 0, 0)).isApprox(Vec3(10, 1, 0), 1e-15));
  EXPECT_TRUE(placement.to_object(Vec3(10, 1, 0)).isApprox(Vec3(1, 0, 0), 1e-15));
}

TEST(Placement, RefusesWhatIsNoPose) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault_of = [](const Vec3& position, const Quat& orientation) {
    std::string fault;
    EXPECT_TRUE(Placement::make(position, orientation, fault).is_identity());
    return fault;
  };
  EXPECT_THAT(fault_of(Vec3(nan, 0, 0), Quat::Identity()), HasSubstr("not finite"));
  EXPECT_THAT(fault_of(Vec3::Zero(), Quat(1, 0, nan, 0)), HasSubstr("not finite"));
  EXPECT_THAT(fault_of(Vec3(0, -1.1e9, 0), Quat::Identity()), HasSubstr("1e9 m"));
  EXPECT_THAT(fault_of(Vec3::Zero(), Quat(0, 0, 0, 0)), HasSubstr("no direction"));
  EXPECT_THAT(fault_of(Vec3::Zero(), Quat(0, 1e-200, 0, 0)), HasSubstr("no direction"));
  EXPECT_THAT(fault_of(Vec3::Zero(), Quat(1e200, 0, 0, 0)), HasSubstr("no direction"));
}

}  // namespace
}  // namespace camway::scene
