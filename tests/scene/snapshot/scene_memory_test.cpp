// SPDX-License-Identifier: MIT
// A separate program, because it replaces operator new.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <optional>

#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/random.h"

namespace {

std::atomic<std::int64_t> live_bytes = 0;

void* allocate(std::size_t size) {
  void* const memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  live_bytes += static_cast<std::int64_t>(malloc_usable_size(memory));
  return memory;
}

void release(void* memory) {
  if (memory != nullptr) live_bytes -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }

namespace camway::scene {
namespace {

using geometry::Vec3;
using ChangeKind = SceneChange::Kind;

constexpr std::uint64_t kMemorySeed = 1503;

/// Returns a sphere of some thousand triangles, or a map of as many voxels.
std::shared_ptr<const ObjectSource> random_source(testing::Random& random) {
  ObjectOptions options;
  if (random() % 2 == 0) options.field.reset();
  if (random() % 3 != 0) {
    const double chord_error_m = 1e-4 * static_cast<double>(1 + random() % 20);
    Mesh mesh = *sphere_mesh(1.0, chord_error_m);
    const ImportReport report = report_of(mesh, "sphere");
    return make_source(ObjectKind::kSphere, std::move(mesh), report, options);
  }
  VoxelSet voxels;
  for (int i = static_cast<int>(random() % 5000); i >= 0; --i) {
    const auto at = [&] { return static_cast<std::int32_t>(random() % 60); };
    voxels.insert(Voxel{at(), at(), at()});
  }
  const auto map = VoxelMap::build(0.1, voxels, {}, UnknownSpace::kFree).map;
  return make_map_source(map, report_of(*map, "OctoMap"), options, geometry::Vec3::Zero());
}

/// Returns a map after a scan of a solid wall: some of its blocks differ.
std::shared_ptr<const ObjectSource> scanned(testing::Random& random, const VoxelMap& map) {
  std::vector<ScannedBlock> blocks;
  for (int i = static_cast<int>(random() % 5); i >= 0; --i) {
    const auto at = [&] { return static_cast<std::int32_t>(random() % 60); };
    ScannedBlock block;
    block.key = BlockKey::of(Voxel{at(), at(), at()});
    block.occupied.fill(~std::uint64_t{0});
    auto beliefs = std::make_shared<Beliefs>();
    beliefs->fill(1.0F);
    block.beliefs = std::move(beliefs);
    blocks.push_back(std::move(block));
  }
  const auto next = map.with(blocks).map;
  return make_map_source(next, report_of(*next, "OctoMap"), {}, geometry::Vec3::Zero());
}

SceneChange random_change(testing::Random& random, const Snapshot& scene) {
  SceneChange change;
  change.object = std::string(1, static_cast<char>('a' + random() % 4));
  const SceneObject* const object = scene.find(change.object);
  const auto kind = random() % 4;
  change.kind = object == nullptr || kind < 2 ? ChangeKind::kPut
                : kind == 2                   ? ChangeKind::kRemove
                                              : ChangeKind::kMove;
  if (change.kind == ChangeKind::kPut) {
    const bool is_scan = object != nullptr && object->source->map_O && random() % 4 != 0;
    change.source = is_scan ? scanned(random, *object->source->map_O) : random_source(random);
  }
  return change;
}

/// Compares the reported bytes of a history with the memory that its destruction frees.
TEST(SceneHistory, KeepsWhatItsBytesSay) {
  testing::Random random(kMemorySeed);
  for (int trial = 0; trial < 20; ++trial) {
    std::shared_ptr<const Snapshot> scene = assemble("room", 1, {}, {});
    const int before = static_cast<int>(random() % 4);
    for (int i = 0; i < before; ++i) {
      const SceneChange change = random_change(random, *scene);
      scene = changed(*scene, change, scene->revision + 1).snapshot;
    }
    std::optional<SceneHistory> history(std::in_place, *scene, SceneHistory::Limits{});
    const int changes = static_cast<int>(random() % 12);
    for (int i = 0; i < changes; ++i) {
      SceneChange change = random_change(random, *scene);
      scene = changed(*scene, change, scene->revision + 1).snapshot;
      ASSERT_TRUE(scene);
      history->add({std::move(change)}, {scene->revision, {}});
    }
    const auto said = static_cast<std::int64_t>(history->bytes());
    const std::int64_t with_history = live_bytes;
    history.reset();
    const std::int64_t kept = with_history - live_bytes;
    // Entries, names and reports, and the allocator's overhead, for each source.
    const std::int64_t beside = 4096 * (1 + changes + before);
    EXPECT_LE(kept, said + said / 20 + beside)
        << "trial " << trial << ": it keeps more than it says";
    EXPECT_GE(kept + beside, said - said / 20) << "trial " << trial << ": or less";
  }
}

/// Many revisions of a map that scans change a little take little more memory than the map.
TEST(SceneHistory, KeepsOfScansWhatTheyChanged) {
  testing::Random random(kMemorySeed);
  VoxelSet voxels;
  voxels.insert(VoxelCube{{0, 0, 0}, 256});
  const auto map = VoxelMap::build(0.1, voxels, {}, UnknownSpace::kFree).map;
  SceneChange change{ChangeKind::kPut,
                     "map",
                     make_map_source(map, report_of(*map, "OctoMap"), {}, geometry::Vec3::Zero()),
                     {}};
  const std::uint64_t bytes_of_map = change.source->memory_bytes();
  auto scene = assemble("room", 1, {}, {});
  scene = changed(*scene, change, 2).snapshot;
  SceneHistory history(*scene, {.bytes = bytes_of_map});
  for (int i = 0; i < 20; ++i) {
    change.source = scanned(random, *scene->find("map")->source->map_O);
    scene = changed(*scene, change, scene->revision + 1).snapshot;
    history.add({change}, {scene->revision, {}});
  }
  EXPECT_EQ(history.entries().size(), 20U);
  EXPECT_LE(history.bytes(), bytes_of_map);
}

}  // namespace
}  // namespace camway::scene
