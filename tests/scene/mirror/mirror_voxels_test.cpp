// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/mirror_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

#include "daemon/scene/voxels/voxel_faces.h"
#include "tests/support/random.h"
#include "tests/support/sanitizer.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::Vec3;

constexpr std::uint64_t kVoxelsSeed = 77411;
constexpr double kCellM = 0.25;

/// A placed map with its faces.
struct PlacedMap {
  std::optional<PlacedVoxelMap> solid;
  std::vector<Mesh> faces_W;
  std::vector<const Mesh*> meshes;

  PlacedMap(double cell_m, const VoxelSet& voxels, const Placement& placement) {
    const std::shared_ptr<const VoxelMap> map =
        VoxelMap::build(cell_m, voxels, {}, UnknownSpace::kFree).map;
    geometry::Box bounds_W;
    for (const MeshPart& part : map->faces()->parts()) {
      faces_W.push_back(placed_mesh(*part.mesh, placement));
      bounds_W.extend(faces_W.back().bounds());
    }
    for (const Mesh& mesh : faces_W) meshes.push_back(&mesh);
    solid = PlacedVoxelMap{map, placement, bounds_W};
  }

  [[nodiscard]] MirrorTask task(double resolution_m, std::uint64_t max_voxels,
                                const std::stop_token& stop = {}) const {
    return {meshes, solid, VoxelGrid(resolution_m), max_voxels, stop};
  }
};

constexpr std::uint64_t kMany = 1'000'000'000'000;

Placement random_placement(testing::Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::string fault;
  return Placement::make(10.0 * Vec3(unit(random), unit(random), unit(random)),
                         Quat(unit(random), unit(random), unit(random), unit(random)), fault);
}

/// Returns single voxels, and cubes of which some fill blocks and some cross them.
VoxelSet scattered_voxels(testing::Random& random) {
  std::uniform_int_distribution<std::int32_t> anywhere(-14, 14);
  VoxelSet voxels;
  for (int i = 0; i < 12; ++i) {
    voxels.insert(Voxel{anywhere(random), anywhere(random), anywhere(random)});
  }
  const std::int32_t block = random() % 2 == 0 ? -8 : 0;
  voxels.insert(VoxelCube{{block, 0, block}, 8});
  Voxel voxel{};
  for (voxel[0] = 3; voxel[0] < 9; ++voxel[0]) {
    for (voxel[1] = -9; voxel[1] < -2; ++voxel[1]) {
      for (voxel[2] = 5; voxel[2] < 11; ++voxel[2]) voxels.insert(voxel);
    }
  }
  return voxels;
}

std::vector<Voxel> listed(const VoxelSet& voxels) {
  std::vector<Voxel> list;
  voxels.for_each([&](const Voxel& voxel) { list.push_back(voxel); });
  std::ranges::sort(list);
  return list;
}

/// Returns the voxels that faces touch, and all others in their box whose centre is in the solid.
VoxelSet by_asking_all(const PlacedMap& map, double resolution_m) {
  const std::optional<PlacedVoxelMap> nothing;
  const VoxelGrid grid(resolution_m);
  VoxelSet voxels = *mirror_voxels({map.meshes, nothing, grid, kMany, {}}).voxels;
  const VoxelSet::Range box = voxels.bounds();
  Voxel voxel{};
  for (voxel[0] = box[0].first; voxel[0] <= box[0].last; ++voxel[0]) {
    for (voxel[1] = box[1].first; voxel[1] <= box[1].last; ++voxel[1]) {
      for (voxel[2] = box[2].first; voxel[2] <= box[2].last; ++voxel[2]) {
        if (map.solid->holds(grid.box({voxel, 1}).center())) voxels.insert(voxel);
      }
    }
  }
  return voxels;
}

TEST(MirrorVoxels, AreThoseThatFacesTouchAndThoseInside) {
  testing::Random random(kVoxelsSeed);
  for (int run = 0; run < 6; ++run) {
    const Placement placement = run % 3 == 0 ? Placement() : random_placement(random);
    const PlacedMap map(kCellM, scattered_voxels(random), placement);
    for (const double resolution_m : {0.4 * kCellM, 0.5 * kCellM, kCellM, 2.7 * kCellM, 5.0}) {
      const MirrorVoxels made = mirror_voxels(map.task(resolution_m, kMany));
      ASSERT_TRUE(made.voxels);
      ASSERT_EQ(listed(*made.voxels), listed(by_asking_all(map, resolution_m)))
          << "run " << run << ", " << resolution_m << " m";
    }
  }
}

TEST(MirrorVoxels, RefusesWhatPassesTheLimitAndNothingElse) {
  testing::Random random(kVoxelsSeed);
  for (int run = 0; run < testing::runs(6); ++run) {
    const PlacedMap map(kCellM, scattered_voxels(random), random_placement(random));
    for (const double resolution_m : {0.1 * kCellM, 0.5 * kCellM, kCellM}) {
      const std::uint64_t voxels = mirror_voxels(map.task(resolution_m, kMany)).voxels->size();
      EXPECT_LE(least_voxels(map.task(resolution_m, kMany)), static_cast<double>(voxels));
      EXPECT_TRUE(mirror_voxels(map.task(resolution_m, voxels)).voxels) << "never too early";
      const MirrorVoxels refused = mirror_voxels(map.task(resolution_m, voxels - 1));
      EXPECT_FALSE(refused.voxels);
      EXPECT_FALSE(refused.is_cancelled);
    }
  }
}

// Filling it would take days.
TEST(MirrorVoxels, KnowsFromTheRoomOfTheSolidWhatIsHopeless) {
  VoxelSet cube;
  cube.insert(VoxelCube{{0, 0, 0}, 64});
  const PlacedMap map(1.0, cube, {});
  const double room = 64e3 * 64e3 * 64e3;
  EXPECT_NEAR(least_voxels(map.task(0.001, kMany)), room, 1e-9 * room);
  EXPECT_FALSE(mirror_voxels(map.task(0.001, kMany)).voxels);
}

TEST(MirrorVoxels, CostWhatTheSolidHasAndNotTheBoxAboutIt) {
  VoxelSet far_apart;
  far_apart.insert(Voxel{-20000, -20000, -20000});
  far_apart.insert(Voxel{20000, 20000, 20000});
  const PlacedMap map(1.0, far_apart, {});
  const MirrorVoxels made = mirror_voxels(map.task(0.9, 1000));
  ASSERT_TRUE(made.voxels);
  EXPECT_LT(made.voxels->size(), 100U);
}

/// Expects that a stop cancels `work`; it comes after `work` has most probably begun.
template <class Work>
void expect_called_off(const Work& work) {
  std::stop_source stop;
  const std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stop.request_stop();
  });
  const MirrorVoxels made = work(stop.get_token());
  EXPECT_TRUE(made.is_cancelled);
  EXPECT_FALSE(made.voxels);
}

// Both would take a minute.
TEST(MirrorVoxels, AStopEndsTheMarkingOfATriangle) {
  Mesh floor;
  floor.vertices = {Vec3(0, 0, 0), Vec3(14, 0, 0), Vec3(0, 14, 0)};
  floor.triangles = {{0, 1, 2}};
  const std::vector<const Mesh*> meshes{&floor};
  const std::optional<PlacedVoxelMap> nothing;
  expect_called_off([&](const std::stop_token& stop) {
    return mirror_voxels({meshes, nothing, VoxelGrid(0.001), kMany, stop});
  });
}

TEST(MirrorVoxels, AStopEndsTheFillingOfASolid) {
  VoxelSet cube;
  cube.insert(VoxelCube{{0, 0, 0}, 16});
  PlacedMap map(1.0, cube, {});
  map.meshes.clear();  // so that it begins with filling
  expect_called_off(
      [&](const std::stop_token& stop) { return mirror_voxels(map.task(0.015, kMany, stop)); });
}

}  // namespace
}  // namespace camway::scene
