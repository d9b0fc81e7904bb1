// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/path_check.h"

#include <gtest/gtest.h>

#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::Keyframe;
using motion::Path;

Path tour() {
  return motion::interpolate(
      std::vector<Keyframe>{{0.0, {{0, 0, 2}, Quat::Identity()}},
                            {1.0, {{0.2, 0, 0}, Quat(Eigen::AngleAxisd(0.7, Vec3::UnitY()))}},
                            {3.0, {{0, 0, -2}, Quat::Identity()}}});
}

motion::Body body() { return motion::Body(testing::small_camera()); }

PathCheck check(const scene::Mesh& mesh, const Deadline& deadline = Deadline::never()) {
  return check_path({collision::Obstacles(scene::SceneIndex::build(mesh)), body()}, tour(),
                    deadline, deadline);
}

TEST(CheckPath, CertifiesAFreePathWithItsClearance) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {1, -1, -1}, {2, 1, 1});
  const PathCheck result = check(mesh);
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_GT(result.certificate.clearance_lower_bound_m, 0.5);
  EXPECT_LT(result.certificate.clearance_lower_bound_m, 0.8);
}

TEST(CheckPath, ListsCollisionsAndCertifiesNothing) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -1.1}, {1, 1, -1});
  const PathCheck result = check(mesh);
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(result.collisions.empty());
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_EQ(result.certificate.clearance_lower_bound_m, 0.0);
}

TEST(CheckPath, KnowsNothingAfterTheDeadline) {
  const PathCheck result = check(scene::Mesh{}, Deadline::after_s(0.0));
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.certificate.certified);
}

}  // namespace
}  // namespace camway::planning
