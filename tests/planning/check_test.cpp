// SPDX-License-Identifier: MIT
#include "daemon/planning/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/motion/interpolate.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using collision::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Keyframe;
using motion::Path;
using motion::Segment;

Path tour() {
  return motion::interpolate(
      std::vector<Keyframe>{{0.0, {{0, 0, 2}, Quat::Identity()}},
                            {1.0, {{0.2, 0, 0}, Quat(Eigen::AngleAxisd(0.7, Vec3::UnitY()))}},
                            {3.0, {{0, 0, -2}, Quat::Identity()}}});
}

Corners corners_C() { return motion::near_corners_C(testing::small_camera()); }

PathCheck check(const scene::Mesh& mesh, const Deadline& deadline = Deadline::never()) {
  return check_path(scene::SceneIndex::build(mesh), tour(), corners_C(), {}, deadline, deadline);
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

TEST(FindJump, AcceptsOurPathsAndNamesTheSegmentOfALeap) {
  const Path path = tour();
  EXPECT_FALSE(find_jump(path, corners_C()));
  std::vector<Segment> segments(path.segments().begin(), path.segments().end());
  ASSERT_GE(segments.size(), 2u);
  segments[1].position[0].x() += 1e-6;
  const std::optional<std::string> jump = find_jump(Path(segments), corners_C());
  ASSERT_TRUE(jump);
  EXPECT_THAT(*jump, ::testing::HasSubstr("segments[1]"));
}

TEST(FindJump, SeesALeapOfTheOrientationToo) {
  const Path path = tour();
  std::vector<Segment> segments(path.segments().begin(), path.segments().end());
  segments[1].orientation[0] += geometry::Vec4(0, 1e-6, 0, 0);
  EXPECT_TRUE(find_jump(Path(segments), corners_C()));
  // The sign and the length of a four-vector mean nothing.
  segments = {path.segments().begin(), path.segments().end()};
  for (geometry::Vec4& q : segments[1].orientation) q *= -3.0;
  EXPECT_FALSE(find_jump(Path(segments), corners_C()));
}

}  // namespace
}  // namespace camway::planning
