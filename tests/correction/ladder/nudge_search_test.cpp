// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/nudge_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "daemon/correction/ladder/corrected_path.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using geometry::Vec3;

constexpr double kBlock_m = 6.0;

/// A block that ends at x = `face_m`, along whose face the camera grazes, and small cuboids in
/// front of it, so that the index divides the faces of the block.
LadderCase along_a_block(double face_m, testing::Random& random) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-kBlock_m, -4, -face_m}, {face_m, 4, face_m});
  for (int i = 0; i < 60; ++i) {
    const Vec3 corner(random.uniform(1.6, 3.5), random.uniform(-3, 3), random.uniform(-3, 3));
    testing::add_cuboid(mesh, corner, corner + Vec3::Constant(0.05));
  }
  return case_with(mesh, {at(0, {face_m + 0.02, 0, 2.5}), at(5, {face_m + 0.02, 0, -2.5})});
}

bool is_in_block(const Vec3& point_W, double face_m) {
  return -kBlock_m < point_W.x() && point_W.x() < face_m && std::abs(point_W.y()) < 4.0 &&
         std::abs(point_W.z()) < face_m;
}

// The index visits a triangle more than once, which must not count as two surfaces.
TEST(NudgeSearch, LeadsIntoNoSolid) {
  testing::Random random(3);
  int nudges = 0;
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const double face_m = random.uniform(0.9, 1.4);
    const LadderCase c = along_a_block(face_m, random);
    const motion::CubicPath path = c.path();
    const std::vector<collision::CollisionInterval> collisions = c.collisions(path);
    if (collisions.empty()) continue;
    FreeSpace space(c.query());
    const base::Deadline never = base::Deadline::never();
    const CorrectedPath corrected(path, c.keyframes, {200, 0.0}, never);
    Problem problem = corrected.part_about(0, motion::TimeOrigin{}, space.ball_radius_m());
    problem.interval = collisions.front();
    NudgeSearch search(problem, {collisions.data(), 1}, NudgeKind::kMove, space);
    for (const Nudge& nudge : search.smallest()) {
      ++nudges;
      const motion::Pose middle = motion::unsigned_pose(search.nudged_middle(nudge));
      EXPECT_FALSE(is_in_block(space.center_W(middle), face_m));
    }
  }
  EXPECT_GT(nudges, 60);
}

}  // namespace
}  // namespace camway::correction
