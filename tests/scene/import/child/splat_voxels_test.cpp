// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/splat_voxels.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "daemon/scene/import/import.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

using camway::testing::Random;
using camway::testing::TemporaryFolder;
using geometry::Vec3;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::uint64_t kVoxelSeed = 20261126;

/// A file of voxels as splat-transform writes it, of the voxels for which `is_solid` says so.
struct VoxelFile {
  std::array<double, 3> begin{};
  double edge = 0.125;
  int depth = 2;
  std::array<int, 3> size{16, 16, 16};

  std::vector<std::uint32_t> nodes;
  std::vector<std::uint32_t> leaves;

  void build(const std::function<bool(const Voxel&)>& is_solid) {
    struct Cube {
      VoxelCube cube;
      int depth;
    };
    // In levels, so that children follow one another.
    std::vector<Cube> level{{{{0, 0, 0}, 4 << depth}, 0}};
    nodes.assign(1, 0);
    std::size_t first = 0;
    while (!level.empty()) {
      std::vector<Cube> next;
      for (std::size_t i = 0; i < level.size(); ++i) {
        const int solid = count(level[i].cube, is_solid);
        const int edge_voxels = level[i].cube.size;
        if (solid == edge_voxels * edge_voxels * edge_voxels) {
          nodes[first + i] = 0xFF000000;
        } else if (level[i].depth == depth) {
          nodes[first + i] = static_cast<std::uint32_t>(leaves.size() / 2);
          add_leaf(level[i].cube, is_solid);
        } else {
          std::uint32_t mask = 0;
          const auto at = static_cast<std::uint32_t>(first + level.size() + next.size());
          for (unsigned octant = 0; octant < 8; ++octant) {
            const VoxelCube child = level[i].cube.child(octant);
            if (count(child, is_solid) == 0) continue;
            mask |= 1U << octant;
            next.push_back({child, level[i].depth + 1});
          }
          nodes[first + i] = mask << 24U | at;
        }
      }
      first += level.size();
      nodes.resize(nodes.size() + next.size());
      level = next;
    }
  }

  static int count(const VoxelCube& cube, const std::function<bool(const Voxel&)>& is_solid) {
    int sum = 0;
    for_each(cube, [&](const Voxel& voxel) { sum += is_solid(voxel) ? 1 : 0; });
    return sum;
  }
  static void for_each(const VoxelCube& cube, const std::function<void(const Voxel&)>& visit) {
    for (int z = 0; z < cube.size; ++z) {
      for (int y = 0; y < cube.size; ++y) {
        for (int x = 0; x < cube.size; ++x) {
          visit({cube.min[0] + x, cube.min[1] + y, cube.min[2] + z});
        }
      }
    }
  }
  void add_leaf(const VoxelCube& cube, const std::function<bool(const Voxel&)>& is_solid) {
    std::uint64_t bits = 0;
    int bit = 0;
    for_each(cube, [&](const Voxel& voxel) {
      if (is_solid(voxel)) bits |= std::uint64_t{1} << bit;
      ++bit;
    });
    leaves.push_back(static_cast<std::uint32_t>(bits));
    leaves.push_back(static_cast<std::uint32_t>(bits >> 32U));
  }

  [[nodiscard]] std::string json() const {
    const auto end = [&](std::size_t k) { return begin[k] + size[k] * edge; };
    return fmt::format(
        R"({{"version": "1.1", "asset": {{"generator": "test"}},
            "gridBounds": {{"min": [{}, {}, {}], "max": [{}, {}, {}]}},
            "voxelResolution": {}, "leafSize": 4, "treeDepth": {}, "nodeCount": {},
            "leafDataCount": {}}})",
        begin[0], begin[1], begin[2], end(0), end(1), end(2), edge, depth, nodes.size(),
        leaves.size());
  }
  [[nodiscard]] std::string tree() const {
    std::string bytes(reinterpret_cast<const char*>(nodes.data()), 4 * nodes.size());
    return bytes.append(reinterpret_cast<const char*>(leaves.data()), 4 * leaves.size());
  }
  [[nodiscard]] std::string write(const TemporaryFolder& folder) const {
    std::ofstream(folder.path() / "room.voxel.bin", std::ios::binary) << tree();
    return folder.write("room.voxel.json", json());
  }
};

std::set<Voxel> random_solid(Random& random, const std::array<int, 3>& size) {
  std::set<Voxel> solid;
  for (int i = random.integer(1, 30); i > 0; --i) {
    Voxel low{};
    Voxel high{};
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = random.integer(0, size[k] - 1);
      high[k] = std::min(size[k], low[k] + random.integer(1, 9));
    }
    for (int x = low[0]; x < high[0]; ++x) {
      for (int y = low[1]; y < high[1]; ++y) {
        for (int z = low[2]; z < high[2]; ++z) solid.insert({x, y, z});
      }
    }
  }
  return solid;
}

Vec3 in_scene(const Vec3& p, UpAxis up) {
  if (up == UpAxis::kZToY) return {p.x(), p.z(), -p.y()};
  if (up == UpAxis::kYToZ) return {p.x(), -p.z(), p.y()};
  return p;
}

TEST(SplatVoxels, HaveNamesOfTheirOwn) {
  EXPECT_TRUE(is_splat_voxel_name("a.voxel.json") && is_splat_voxel_name("A.VOXEL.JSON"));
  EXPECT_FALSE(is_splat_voxel_name("a.json") || is_splat_voxel_name(".voxel.json") ||
               is_splat_voxel_name("a.voxel.bin"));
}

TEST(SplatVoxels, AreThoseOfTheFile) {
  Random random(kVoxelSeed);
  const TemporaryFolder folder;
  for (int trial = 0; trial < 24; ++trial) {
    VoxelFile file;
    file.edge = trial % 2 == 0 ? 0.1 : 0.05;
    // Aligned with the origin or not.
    for (double& at : file.begin) {
      at = trial % 4 < 2 ? file.edge * random.integer(-30, 30) : random.uniform(-9.0, 9.0);
    }
    file.depth = random.integer(1, 3);
    for (int& side : file.size) side = std::min(4 << file.depth, 4 * random.integer(1, 8));
    const std::set<Voxel> solid = random_solid(random, file.size);
    file.build([&](const Voxel& voxel) { return solid.contains(voxel); });
    ImportOptions import;
    import.up = std::array{UpAxis::kAsInFile, UpAxis::kZToY,
                           UpAxis::kYToZ}[static_cast<std::size_t>(trial % 3)];
    SnapshotOptions options;
    options.import = import;
    const SnapshotResult scene = load_snapshot("room", file.write(folder), options);
    ASSERT_TRUE(scene.snapshot) << scene.error;
    const PlacedVoxelMap map = *scene.snapshot->objects[0]->solid();
    EXPECT_EQ(map.map->resolution_m(), file.edge);
    EXPECT_EQ(map.map->occupied().size(), solid.size());
    const bool is_aligned = map.placement.is_identity();
    EXPECT_TRUE(is_aligned || trial % 4 >= 2);
    for (int x = -1; x <= file.size[0]; ++x) {
      for (int y = -1; y <= file.size[1]; ++y) {
        for (int z = -1; z <= file.size[2]; ++z) {
          const Vec3 middle = Vec3(file.begin[0], file.begin[1], file.begin[2]) +
                              file.edge * Vec3(x + 0.5, y + 0.5, z + 0.5);
          ASSERT_EQ(map.holds(in_scene(middle, import.up)), solid.contains({x, y, z}));
        }
      }
    }
  }
}

TEST(SplatVoxels, CloseTheirGridWhereUnknownSpaceIsOccupied) {
  Random random(kVoxelSeed);
  const TemporaryFolder folder;
  VoxelFile file;
  file.size = {12, 8, 16};
  file.begin = {0.3, 0.7, 0.1};
  const std::set<Voxel> solid = random_solid(random, file.size);
  file.build([&](const Voxel& voxel) { return solid.contains(voxel); });
  const std::string name = file.write(folder);
  const ImportResult open = import_mesh(name, {});
  ASSERT_TRUE(open.map) << open.error;
  EXPECT_TRUE(open.map->free().empty());
  EXPECT_THAT(open.report.notes, Contains(HasSubstr("counts as solid for SuperSplat")));
  const ImportResult closed = import_mesh(name, {.unknown = UnknownSpace::kOccupied});
  ASSERT_TRUE(closed.map) << closed.error;
  EXPECT_EQ(closed.map->free().size(), 12U * 8U * 16U - solid.size());
  EXPECT_EQ(closed.map->solid().size(), solid.size() + 14U * 10U * 18U - 12U * 8U * 16U);
}

TEST(SplatVoxels, AreRefusedWithWhatIsWrong) {
  const TemporaryFolder folder;
  VoxelFile good;
  good.build([](const Voxel& voxel) { return voxel[0] == 3; });
  const auto fault = [&](const std::function<void(VoxelFile&)>& damage) {
    VoxelFile file = good;
    damage(file);
    return import_mesh(file.write(folder), {}).error;
  };
  EXPECT_EQ(fault([](VoxelFile&) {}), "");
  EXPECT_THAT(fault([](VoxelFile& f) {
                f.nodes[0] = 0xFF000000 | 1;
                f.nodes.resize(4);
              }),
              HasSubstr("node 0: has children 1 to 8 of 4 nodes"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.nodes[1] = f.nodes[1] & 0xFF000000; }),
              HasSubstr("node 1: has children 0 to"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.nodes[0] = 0; }), HasSubstr("node 0: is a leaf"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.nodes.back() = 0x00FFFFFF; }),
              HasSubstr("is leaf 16777215"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.nodes.back() = 0x01000001; }),
              HasSubstr("has children below the leaves"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.nodes[2] = f.nodes[1]; }), HasSubstr("two parents"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.edge = 0.0; }), HasSubstr("voxelResolution"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.depth = 14; }), HasSubstr("treeDepth"));
  EXPECT_THAT(fault([](VoxelFile& f) { f.size[1] = 0; }), HasSubstr("gridBounds"));
  std::ofstream(folder.path() / "room.voxel.bin") << "short";
  EXPECT_THAT(import_mesh(folder.write("room.voxel.json", good.json()), {}).error,
              HasSubstr("'room.voxel.bin' has 5 bytes"));
  EXPECT_THAT(import_mesh(folder.write("lone.voxel.json", good.json()), {}).error,
              HasSubstr("'lone.voxel.bin', beside it, is not there"));
  EXPECT_THAT(import_mesh(folder.write("room.voxel.json", "[1"), {}).error,
              HasSubstr("is no JSON object"));
  EXPECT_THAT(import_mesh(folder.write("room.voxel.json", "{}"), {}).error, HasSubstr("version"));
}

}  // namespace
}  // namespace camway::scene
