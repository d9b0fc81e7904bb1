// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

/// Scenes with solids: occupancy maps.
namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Keyframe;
using motion::Path;
using scene::Voxel;
using scene::VoxelSet;

constexpr double kEdgeM = 0.5;

std::shared_ptr<const scene::Snapshot> scene_of(const VoxelSet& occupied,
                                                const scene::Placement& placement = {}) {
  const auto map = scene::VoxelMap::build(kEdgeM, occupied, {}, scene::UnknownSpace::kFree).map;
  const auto source =
      scene::make_map_source(map, scene::report_of(*map, "test"), {}, geometry::Vec3::Zero());
  return scene::assemble("map", 1, {scene::place_object("map", source, placement, {}).object}, {});
}

VoxelSet block(std::int32_t side) {
  VoxelSet set;
  for (std::int32_t i = 0; i < side * side * side; ++i) {
    set.insert(Voxel{i % side, i / side % side, i / side / side});
  }
  return set;
}

Path straight(const Vec3& from, const Vec3& to) {
  const Quat level = Quat::Identity();
  return motion::interpolate(std::vector<Keyframe>{{0.0, {from, level}}, {1.0, {to, level}}});
}

std::vector<CollisionInterval> detect(const scene::Snapshot& snapshot, const Path& path,
                                      const motion::Body& body) {
  return detect_collisions({Obstacles(snapshot), body}, path, path.begin_s(), path.end_s(),
                           base::Deadline::never())
      .value();
}

/// The block is [0, 4]^3 m, and the body is far smaller than a voxel.
TEST(Solids, ABodyThatNeverLeavesTheInsideCollidesAllTheTime) {
  const auto snapshot = scene_of(block(8));
  const auto ball = motion::Body::make(motion::SphereShape{Vec3::Zero(), 0.01});
  for (const motion::Body& body : {motion::Body(testing::small_camera()), *ball}) {
    const std::vector<CollisionInterval> found =
        detect(*snapshot, straight({1.7, 1.7, 1.8}, {2.3, 2.2, 2.4}), body);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].t_begin_s, 0.0);
    EXPECT_EQ(found[0].t_end_s, 1.0);
    EXPECT_TRUE(detect(*snapshot, straight({-3, 2, 2}, {-1, 2, 2}), body).empty());
    const auto clearance =
        path_clearance(Obstacles(*snapshot), straight({1.7, 1.7, 1.8}, {2.3, 2.2, 2.4}), body,
                       base::Deadline::never());
    EXPECT_EQ(clearance->lower_bound_m, 0.0);
  }
}

TEST(Solids, AWayInCollidesFromTheFaceOnAndOutAgainToIt) {
  const auto snapshot = scene_of(block(8));
  const auto ball = motion::Body::make(motion::SphereShape{Vec3::Zero(), 0.01});
  const auto in = detect(*snapshot, straight({-2, 2, 2}, {2, 2, 2}), *ball);
  ASSERT_EQ(in.size(), 1U);
  EXPECT_NEAR(in[0].t_begin_s, 1.99 / 4.0, 1e-3);
  EXPECT_EQ(in[0].t_end_s, 1.0);
  const auto through = detect(*snapshot, straight({-2, 2, 2}, {6, 2, 2}), *ball);
  ASSERT_EQ(through.size(), 1U);
  EXPECT_NEAR(through[0].t_begin_s, 1.99 / 8.0, 1e-3);
  EXPECT_NEAR(through[0].t_end_s, 6.01 / 8.0, 1e-3);
  const auto out = detect(*snapshot, straight({2, 2, 2}, {6, 2, 2}), *ball);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].t_begin_s, 0.0);
  EXPECT_NEAR(out[0].t_end_s, 2.01 / 4.0, 1e-3);
}

/// At every instant that is called free, no point of the body is in an occupied voxel, by the
/// coordinates of the voxels alone.
TEST(Solids, NothingThatIsFreeIsInAnOccupiedVoxel) {
  constexpr std::uint64_t kSeed = 7301;
  testing::Random random(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const motion::Corners corners_C = motion::near_corners_C(testing::small_camera());
  int free_samples = 0;
  int inside_samples = 0;
  for (int trial = 0; trial < 40; ++trial) {
    VoxelSet occupied;
    for (int i = 0; i < 6; ++i) {
      const auto at = [&] { return static_cast<std::int32_t>(std::floor(2.0 * unit(random))); };
      const std::int32_t size = 1 << random() % 3;
      occupied.insert(scene::VoxelCube{{size * at(), size * at(), size * at()}, size});
    }
    std::string fault;
    const scene::Placement placement = scene::Placement::make(
        trial % 2 == 0 ? Vec3(Vec3::Zero()) : Vec3(9.0 * unit(random), 3.0, -2.0),
        trial % 2 == 0 ? Quat::Identity() : random.rotation(), fault);
    const auto snapshot = scene_of(occupied, placement);
    std::vector<Keyframe> keyframes;
    for (int k = 0; k < 4; ++k) {
      const Vec3 point_O = 3.0 * Vec3(unit(random), unit(random), unit(random));
      keyframes.push_back(
          {static_cast<double>(k), {placement.to_world(point_O), random.rotation()}});
    }
    const Path path = motion::interpolate(keyframes);
    const auto found = detect(*snapshot, path, motion::Body(corners_C));
    for (double t = 0.0; t <= 3.0; t += 0.01) {
      const motion::Pose pose = path.pose(t);
      bool is_in_voxel = false;
      for (const Vec3& corner_C : corners_C) {
        const Vec3 at_O = placement.to_object(pose.position + pose.orientation * corner_C) / kEdgeM;
        is_in_voxel |= occupied.contains({static_cast<std::int32_t>(std::floor(at_O.x())),
                                          static_cast<std::int32_t>(std::floor(at_O.y())),
                                          static_cast<std::int32_t>(std::floor(at_O.z()))});
      }
      const bool is_free = std::ranges::none_of(found, [t](const auto& interval) {
        return interval.t_begin_s <= t && t <= interval.t_end_s;
      });
      ASSERT_FALSE(is_free && is_in_voxel) << "trial " << trial << ", t = " << t;
      free_samples += is_free ? 1 : 0;
      inside_samples += is_in_voxel ? 1 : 0;
    }
  }
  EXPECT_GT(free_samples, 1000);
  EXPECT_GT(inside_samples, 500);
}

}  // namespace
}  // namespace camway::collision
