// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <fstream>

#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/scene/cache/prepared_matchers.h"
#include "tests/scene/cache/prepared_samples.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

using testing::expect_same;
using testing::prepared_of;

constexpr std::uint64_t kCacheSeed = 20261125;

class CachedSnapshot : public ::testing::Test {
 protected:
  SnapshotResult load(const std::string& file, const SnapshotOptions& options = {}) const {
    return load_snapshot("scene", file, options, {}, &cache_);
  }
  std::string write_obj(const std::string& name, const Mesh& mesh) const {
    std::ofstream out(folder_.path() / name);
    out.precision(17);
    for (const geometry::Vec3& v : mesh.vertices) {
      out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    std::size_t at = 0;
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
      if (at++ % 7 == 0) out << "o part" << at << '\n';
      out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
    return (folder_.path() / name).string();
  }

  testing::TemporaryFolder folder_;
  SceneCache cache_{folder_.path() / "cache", {.least_triangles = 1}};
};

void expect_same_scene(const Snapshot& a, const Snapshot& b) {
  testing::expect_same(prepared_of(a), prepared_of(b));
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_TRUE(a.index.has_same_trees_as(b.index));
  EXPECT_TRUE(a.index.statistics() == b.index.statistics());
  EXPECT_TRUE(testing::has_same_bits(a.index.bounds(), b.index.bounds()));
  EXPECT_EQ(a.why_no_field, b.why_no_field);
  ASSERT_EQ(a.field == nullptr, b.field == nullptr);
  testing::expect_same_report(a.report, b.report);
  const ObjectSource& source = *a.objects[0]->source;
  const ObjectSource& other = *b.objects[0]->source;
  EXPECT_EQ(source.kind, other.kind);
  EXPECT_TRUE(testing::has_same_bits(source.bounds_O, other.bounds_O));
  EXPECT_TRUE(testing::has_same_bits(source.parts_O[0].bounds, other.parts_O[0].bounds));
  EXPECT_TRUE(testing::has_same_bits(a.objects[0]->bounds_W, b.objects[0]->bounds_W));
  EXPECT_EQ(a.objects[0]->triangles, b.objects[0]->triangles);
}

TEST_F(CachedSnapshot, IsTheOneWithoutACacheToTheBit) {
  testing::Random random(kCacheSeed);
  for (const int triangles : {1, 40, 3000}) {
    for (const bool has_field : {true, false}) {
      SCOPED_TRACE(::testing::Message() << triangles << " triangles, field " << has_field);
      const std::string file =
          write_obj("scene.obj", testing::scattered_triangles(random, triangles, 0.2));
      SnapshotOptions options;
      options.import.up = random.chance(0.5) ? UpAxis::kZToY : UpAxis::kAsInFile;
      options.import.scale = random.uniform(0.1, 3.0);
      if (!has_field) options.field.reset();
      const SnapshotResult without = load_snapshot("scene", file, options);
      const SnapshotResult first = load(file, options);
      const SnapshotResult second = load(file, options);
      ASSERT_TRUE(without.snapshot && first.snapshot && second.snapshot);
      EXPECT_FALSE(first.is_from_cache);
      ASSERT_TRUE(second.is_from_cache);
      expect_same_scene(*without.snapshot, *first.snapshot);
      expect_same_scene(*without.snapshot, *second.snapshot);
    }
  }
}

TEST_F(CachedSnapshot, HasTheMirrorOfTheScene) {
  testing::Random random(kCacheSeed);
  const std::string file = write_obj("scene.obj", testing::scattered_triangles(random, 100, 0.2));
  SnapshotOptions options;
  options.occupancy_resolution_m = 0.1;
  load(file);
  const SnapshotResult cached = load(file, options);
  ASSERT_TRUE(cached.is_from_cache) << "the mirror is no part of the key";
  const SnapshotResult without = load_snapshot("scene", file, options);
  EXPECT_EQ(cached.snapshot->occupancy->statistics().occupied_voxels,
            without.snapshot->occupancy->statistics().occupied_voxels);
  options.mirror_voxels = 1;
  const SnapshotResult too_many = load(file, options);
  EXPECT_EQ(too_many.error, load_snapshot("scene", file, options).error);
  EXPECT_EQ(too_many.limit, Limit::kMirrorVoxels);
}

TEST_F(CachedSnapshot, IsNotThatOfAnEarlierFileOrOfOtherOptions) {
  testing::Random random(kCacheSeed);
  const std::string file = write_obj("scene.obj", testing::scattered_triangles(random, 50, 0.2));
  const std::string digest = load(file).snapshot->digest;
  SnapshotOptions inches;
  inches.import.scale = 0.0254;
  EXPECT_FALSE(load(file, inches).is_from_cache);
  write_obj("scene.obj", testing::scattered_triangles(random, 50, 0.2));
  const SnapshotResult changed = load(file);
  EXPECT_FALSE(changed.is_from_cache);
  EXPECT_NE(changed.snapshot->digest, digest);
}

TEST_F(CachedSnapshot, IsMadeAnewWhereItsFileIsDamaged) {
  testing::Random random(kCacheSeed);
  const std::string file = write_obj("scene.obj", testing::scattered_triangles(random, 50, 0.2));
  const SnapshotResult first = load(file);
  ASSERT_TRUE(load(file).is_from_cache);
  for (const auto& entry : std::filesystem::directory_iterator(cache_.folder())) {
    std::filesystem::resize_file(entry.path(), entry.file_size() - 1);
  }
  const SnapshotResult second = load(file);
  EXPECT_FALSE(second.is_from_cache);
  expect_same_scene(*first.snapshot, *second.snapshot);
  EXPECT_TRUE(load(file).is_from_cache) << "and is kept again";
}

TEST_F(CachedSnapshot, IsNotThereForABadFile) {
  const std::string file = folder_.write("bad.ply", "no mesh");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(load(file).error, load_snapshot("scene", file).error);
  EXPECT_TRUE(cache_.scenes().empty());
}

}  // namespace
}  // namespace camway::scene
