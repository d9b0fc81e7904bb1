// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "daemon/scene/import/import.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

using camway::testing::TemporaryFolder;
using geometry::Quat;
using geometry::Vec3;
using ::testing::HasSubstr;

constexpr std::uint64_t kMapSeed = 77201;
constexpr double kMapResolution_m = 0.25;

/// Returns a tree with free and occupied voxels, some of them pruned.
octomap::OcTree random_tree(testing::Random& random) {
  octomap::OcTree tree(kMapResolution_m);
  std::uniform_real_distribution<double> anywhere(-2.5, 2.5);
  for (int i = 0; i < 120; ++i) {
    const octomap::point3d at(static_cast<float>(anywhere(random)),
                              static_cast<float>(anywhere(random)),
                              static_cast<float>(anywhere(random)));
    tree.updateNode(at, random() % 2 == 0, true);
  }
  const std::uint32_t low = 32768 + 16 * static_cast<std::uint32_t>(random() % 2);
  for (std::uint32_t i = 0; i < 4 * 4 * 4; ++i) {
    const auto key = [&](std::uint32_t k) { return static_cast<octomap::key_type>(low + k % 4); };
    tree.setNodeValue(octomap::OcTreeKey(key(i), key(i / 4), key(i / 16)), 3.5F, true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

enum class Is { kUnknown, kFree, kOccupied };

Is in_tree(const octomap::OcTree& tree, const Voxel& voxel) {
  const auto key = [](std::int32_t v) { return static_cast<octomap::key_type>(v + 32768); };
  const octomap::OcTreeNode* node =
      tree.search(octomap::OcTreeKey(key(voxel[0]), key(voxel[1]), key(voxel[2])));
  if (node == nullptr) return Is::kUnknown;
  return tree.isNodeOccupied(node) ? Is::kOccupied : Is::kFree;
}

Is in_map(const VoxelMap& map, const Voxel& voxel) {
  if (map.occupied().contains(voxel)) return Is::kOccupied;
  return map.free().contains(voxel) ? Is::kFree : Is::kUnknown;
}

constexpr std::int32_t kReach = 34;  ///< beyond all voxels of a random tree

template <class Visit>
void for_each_around(const Visit& visit) {
  Voxel voxel{};
  for (voxel[0] = -kReach; voxel[0] < kReach; ++voxel[0]) {
    for (voxel[1] = -kReach; voxel[1] < kReach; ++voxel[1]) {
      for (voxel[2] = -kReach; voxel[2] < kReach; ++voxel[2]) visit(voxel);
    }
  }
}

ImportResult imported(octomap::OcTree& tree, const std::string& name,
                      const ImportOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / name).string();
  const bool written = name.ends_with(".bt") ? tree.writeBinary(file) : tree.write(file);
  EXPECT_TRUE(written);
  return import_mesh(file, options);
}

TEST(MapImport, ReadsWhatOctoMapWrote) {
  testing::Random random(kMapSeed);
  for (const std::string name : {"map.bt", "map.ot", "MAP.BT"}) {
    octomap::OcTree tree = random_tree(random);
    const ImportResult result = imported(tree, name == "MAP.BT" ? "x.bt" : name);
    ASSERT_TRUE(result.map) << result.error;
    EXPECT_EQ(result.map->resolution_m(), kMapResolution_m);
    EXPECT_EQ(result.report.format, "OctoMap");
    EXPECT_EQ(result.report.triangles, result.mesh->triangles.size());
    for_each_around(
        [&](const Voxel& voxel) { ASSERT_EQ(in_map(*result.map, voxel), in_tree(tree, voxel)); });
  }
}

TEST(MapImport, TurnsAndScalesLikeAMesh) {
  testing::Random random(kMapSeed);
  octomap::OcTree tree = random_tree(random);
  for (const UpAxis up : {UpAxis::kZToY, UpAxis::kYToZ}) {
    const ImportResult result = imported(tree, "map.bt", {.scale = 4.0, .up = up});
    ASSERT_TRUE(result.map) << result.error;
    EXPECT_EQ(result.map->resolution_m(), 4.0 * kMapResolution_m);
    for_each_around([&](const Voxel& file) {
      const Voxel scene = up == UpAxis::kZToY ? Voxel{file[0], file[2], -file[1] - 1}
                                              : Voxel{file[0], -file[2] - 1, file[1]};
      ASSERT_EQ(in_map(*result.map, scene), in_tree(tree, file));
    });
  }
}

TEST(MapImport, ReadsTreesWithColours) {
  octomap::ColorOcTree tree(0.5);
  tree.updateNode(octomap::point3d(1.1F, 1.1F, 1.1F), true);
  tree.updateNode(octomap::point3d(-1.1F, 1.1F, 1.1F), false);
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "colours.ot").string();
  ASSERT_TRUE(tree.write(file));
  const ImportResult result = import_mesh(file, {});
  ASSERT_TRUE(result.map) << result.error;
  EXPECT_EQ(result.map->occupied().size(), 1U);
  EXPECT_TRUE(result.map->occupied().contains({2, 2, 2}));
  EXPECT_EQ(result.map->free().size(), 1U);
  EXPECT_EQ(result.mesh->triangles.size(), 12U);
}

TEST(MapImport, WhateverIsInAFileGetsAnAnswer) {
  testing::Random random(kMapSeed);
  octomap::OcTree tree = random_tree(random);
  const TemporaryFolder folder;
  for (const std::string name : {"good.bt", "good.ot"}) {
    const std::string good = (folder.path() / name).string();
    ASSERT_TRUE(name == "good.bt" ? tree.writeBinary(good) : tree.write(good));
    std::ifstream in(good, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    for (int trial = 0; trial < 25; ++trial) {
      std::string bad = bytes;
      if (trial % 2 == 0) bad.resize(random() % bad.size() + 1);
      for (int i = trial % 3 * 4; i-- > 0;) {
        bad[random() % bad.size()] = static_cast<char>(random());
      }
      const std::string file = folder.write("bad" + name.substr(4), bad);
      const ImportResult result = import_mesh(file, {.time_limit_s = 20.0});
      ASSERT_EQ(result.mesh.has_value(), result.error.empty());
    }
  }
  const std::string deep =
      folder.write("deep.bt", "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n" +
                                  std::string(4 << 20, '\xff'));
  EXPECT_FALSE(import_mesh(deep, {}).error.empty());
  const std::string mesh = folder.write("mesh.bt", "v 0 0 0\n");
  EXPECT_THAT(import_mesh(mesh, {}).error, HasSubstr("OctoMap"));
}

TEST(VoxelMap, UnknownSpaceFillsTheBoxAndALayerAboutIt) {
  testing::Random random(kMapSeed);
  octomap::OcTree tree = random_tree(random);
  const ImportResult as_free = imported(tree, "map.bt");
  const ImportResult as_occupied = imported(tree, "map.bt", {.unknown = UnknownSpace::kOccupied});
  ASSERT_TRUE(as_free.map && as_occupied.map);
  Voxel low{kReach, kReach, kReach};
  Voxel high{-kReach, -kReach, -kReach};
  for_each_around([&](const Voxel& voxel) {
    if (in_tree(tree, voxel) == Is::kUnknown) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], voxel[axis] - 1);
      high[axis] = std::max(high[axis], voxel[axis] + 1);
    }
  });
  for_each_around([&](const Voxel& voxel) {
    bool in_box = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      in_box = in_box && voxel[axis] >= low[axis] && voxel[axis] <= high[axis];
    }
    const Is is = in_tree(tree, voxel);
    ASSERT_EQ(as_free.map->solid().contains(voxel), is == Is::kOccupied);
    ASSERT_EQ(as_occupied.map->solid().contains(voxel), in_box && is != Is::kFree);
  });
}

TEST(VoxelMap, RefusesWhatIsTooLarge) {
  VoxelSet far;
  far.insert(Voxel{-32768, -32768, -32768});
  far.insert(Voxel{32767, 32767, 32767});
  EXPECT_TRUE(VoxelMap::build(0.1, far, {}, UnknownSpace::kFree).map);
  EXPECT_THAT(VoxelMap::build(0.1, far, {}, UnknownSpace::kOccupied).error, HasSubstr("unknown"));
  EXPECT_THAT(VoxelMap::build(0.0, far, {}, UnknownSpace::kFree).error, HasSubstr("resolution"));
}

/// A point is in the solid exactly if OctoMap calls its voxel occupied, unless rounding hides it.
TEST(SceneSolids, HoldWhatIsInAnOccupiedVoxelWhereverTheMapIs) {
  testing::Random random(kMapSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  octomap::OcTree tree = random_tree(random);
  const ImportResult import = imported(tree, "map.bt");
  ASSERT_TRUE(import.map);
  for (int place = 0; place < 20; ++place) {
    std::string fault;
    const Placement placement =
        place == 0
            ? Placement()
            : Placement::make(1e3 * Vec3(unit(random), unit(random), unit(random)),
                              Quat(unit(random), unit(random), unit(random), unit(random)), fault);
    ASSERT_EQ(fault, "");
    const SceneSolids solids(
        {{import.map, placement, placed_mesh(*import.mesh, placement).bounds()}});
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 point_O = 8.0 * kMapResolution_m * Vec3(unit(random), unit(random), unit(random));
      const Voxel voxel{static_cast<std::int32_t>(std::floor(point_O.x() / kMapResolution_m)),
                        static_cast<std::int32_t>(std::floor(point_O.y() / kMapResolution_m)),
                        static_cast<std::int32_t>(std::floor(point_O.z() / kMapResolution_m))};
      const bool is_inside = in_tree(tree, voxel) == Is::kOccupied;
      inside += is_inside ? 1 : 0;
      ASSERT_EQ(solids.hold(placement.to_world(point_O)), is_inside) << "place " << place;
    }
    EXPECT_GT(inside, 30);
    EXPECT_TRUE(solids.hold({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  }
  const SceneSolids here({{import.map, {}, import.mesh->bounds()}});
  for (const geometry::Vec3& vertex : import.mesh->vertices) EXPECT_TRUE(here.hold(vertex));
}

TEST(Snapshot, OfAMapHasItsVoxelsInTheMirror) {
  testing::Random random(kMapSeed);
  octomap::OcTree tree = random_tree(random);
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "map.bt").string();
  ASSERT_TRUE(tree.writeBinary(file));
  SnapshotOptions options;
  options.occupancy_resolution_m = kMapResolution_m;
  const auto same = load_snapshot("map", file, options).snapshot;
  ASSERT_TRUE(same && same->solids);
  EXPECT_STREQ(to_string(same->objects[0]->source->kind), "occupancy map");
  EXPECT_NE(same->digest, mesh_digest(*same->mesh)) << "its surface alone is another scene";
  options.occupancy_resolution_m = 0.1;
  const auto finer = load_snapshot("map", file, options).snapshot;
  for_each_around([&](const Voxel& voxel) {
    const Vec3 middle =
        (Vec3(voxel[0], voxel[1], voxel[2]).array() + 0.5).matrix() * kMapResolution_m;
    const bool is_occupied = in_tree(tree, voxel) == Is::kOccupied;
    ASSERT_EQ(same->occupancy->occupied_at(middle), is_occupied);
    // The finer map marks voxels that touch a face, so a voxel beside an occupied one may be
    // marked.
    if (is_occupied) {
      ASSERT_TRUE(finer->occupancy->occupied_at(middle)) << "the inside";
    }
  });
}

TEST(VoxelMap, KeepsWithinItsLimits) {
  VoxelSet cube;
  cube.insert(VoxelCube{{0, 0, 0}, 2});
  const auto build = [&](const VoxelMapLimits& limits, UnknownSpace unknown) {
    return VoxelMap::build(0.1, cube, {}, unknown, limits);
  };
  EXPECT_TRUE(build({.voxels = 8}, UnknownSpace::kFree).map);
  EXPECT_THAT(build({.voxels = 7}, UnknownSpace::kFree).error, HasSubstr("more than 7 occupied"));
  // With a layer around it, four on each side.
  EXPECT_TRUE(build({.voxels = 64}, UnknownSpace::kOccupied).map);
  EXPECT_THAT(build({.voxels = 63}, UnknownSpace::kOccupied).error, HasSubstr("more than 63"));
  EXPECT_TRUE(build({.triangles = 48}, UnknownSpace::kFree).map->faces());
  EXPECT_FALSE(build({.triangles = 47}, UnknownSpace::kFree).map->faces());
}

}  // namespace
}  // namespace camway::scene
