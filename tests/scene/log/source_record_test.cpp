// SPDX-License-Identifier: MIT
#include "daemon/scene/log/source_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tests/scene/cache/prepared_matchers.h"
#include "tests/scene/log/source_samples.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::HasSubstr;

constexpr std::uint64_t kRecordSeed = 90417;

std::vector<Voxel> list_of(const VoxelSet& set) {
  std::vector<Voxel> voxels;
  set.for_each([&](const Voxel& voxel) { voxels.push_back(voxel); });
  return voxels;
}

void expect_equal(const VoxelMap& a, const VoxelMap& b) {
  EXPECT_EQ(a.resolution_m(), b.resolution_m());
  EXPECT_EQ(a.unknown(), b.unknown());
  EXPECT_EQ(a.limits(), b.limits());
  EXPECT_EQ(a.sensor(), b.sensor());
  ASSERT_EQ(list_of(a.occupied()), list_of(b.occupied()));
  ASSERT_EQ(list_of(a.free()), list_of(b.free()));
  ASSERT_EQ(list_of(a.solid()), list_of(b.solid()));
  ASSERT_EQ(a.scanned_blocks(), b.scanned_blocks());
  for (const VoxelSet* const set : {&a.occupied(), &a.free()}) {
    for (const std::uint64_t key : set->sorted_keys()) {
      const Beliefs* const of_a = a.beliefs(key);
      const Beliefs* const of_b = b.beliefs(key);
      ASSERT_EQ(of_a == nullptr, of_b == nullptr);
      if (of_a != nullptr) {
        ASSERT_EQ(std::memcmp(of_a->data(), of_b->data(), sizeof *of_a), 0);
      }
    }
  }
}

void expect_equal(const ObjectSource& a, const ObjectSource& b) {
  EXPECT_EQ(a.kind, b.kind);
  testing::expect_same_report(a.report, b.report);
  EXPECT_EQ(a.why_no_field, b.why_no_field);
  EXPECT_EQ(a.field_O == nullptr, b.field_O == nullptr);
  ASSERT_EQ(a.parts_O.size(), b.parts_O.size());
  for (std::size_t i = 0; i < a.parts_O.size(); ++i) {
    EXPECT_EQ(a.parts_O[i].key, b.parts_O[i].key);
    ASSERT_NO_FATAL_FAILURE(testing::expect_same_mesh(*a.parts_O[i].mesh, *b.parts_O[i].mesh));
  }
  ASSERT_EQ(a.map_O == nullptr, b.map_O == nullptr);
  EXPECT_EQ(a.map_origin_O, b.map_origin_O);
  if (a.map_O) expect_equal(*a.map_O, *b.map_O);
}

std::string snapshot_digest(const SourcePtr& source, const Placement& placement) {
  const ObjectOptions options = without_field();
  const ObjectResult placed = place_object("object", source, placement, options);
  EXPECT_TRUE(placed.object) << placed.error;
  if (!placed.object) return placed.error;
  return placed.object->digest + assemble("scene", 1, {placed.object}, options)->digest;
}

/// Expects that both are equal, now and after all that may happen to them.
void expect_same(const SourcePtr& source, const SourcePtr& other) {
  ASSERT_TRUE(source && other);
  ASSERT_NO_FATAL_FAILURE(expect_equal(*source, *other));
  EXPECT_EQ(record_of(*source), record_of(*other));
  std::string fault;
  const Placement turned = Placement::make({1.0, -2.0, 0.3}, Quat(1.0, 0.2, -0.4, 0.1), fault);
  for (const Placement& placement : {Placement(), turned}) {
    const bool is_small = source->bounds_O.isEmpty() || source->bounds_O.sizes().maxCoeff() < 1e8;
    if (!is_small && !placement.is_identity()) continue;
    EXPECT_EQ(snapshot_digest(source, placement), snapshot_digest(other, placement));
  }
}

TEST(SourceRecord, GivesBackAnyMesh) {
  testing::Random random(kRecordSeed);
  for (int trial = 0; trial < 30; ++trial) {
    const SourcePtr source = make_source(
        ObjectKind::kMesh, mesh_of_objects(random, 1 + trial / 3, trial % 2 == 0 ? 1e3 : 1e30),
        random_report(random), without_field());
    const Bytes record = record_of(*source);
    ASSERT_FALSE(*base_of_record(record));
    ASSERT_NO_FATAL_FAILURE(expect_same(source, decoded(record)));
  }
}

TEST(SourceRecord, IsWhatItWasWhereAMapBeginsWhereItsObjectDoes) {
  testing::Random random(kRecordSeed);
  const auto map = map_sample(random, UnknownSpace::kFree, 50);
  const Bytes before = record_of(*source_of_map(map));
  EXPECT_EQ(before[sizeof(std::uint64_t)], std::byte{1});
  const Bytes moved = record_of(*source_of_map(map, {0.0, 0.25, 0.0}));
  EXPECT_EQ(moved[sizeof(std::uint64_t)], std::byte{3});
  EXPECT_EQ(moved.size(), before.size() + 3 * sizeof(double));
  ASSERT_NO_FATAL_FAILURE(expect_same(source_of_map(map, {0.0, 0.25, 0.0}), decoded(moved)));
}

TEST(SourceRecord, GivesBackTheFieldThatTheOptionsAskFor) {
  Mesh mesh = *box_mesh({1.0, 2.0, 3.0});
  const ImportReport report = report_of(mesh, "box");
  const SourcePtr source = make_source(ObjectKind::kBox, std::move(mesh), report, {});
  const base::Result<SourcePtr> other = source_from(record_of(*source), nullptr, {});
  ASSERT_TRUE(other && (*other)->field_O);
  ASSERT_NO_FATAL_FAILURE(expect_equal(*source, **other));
}

/// The version is the number after the eight bytes of the magic number.
std::uint32_t version_of(const Bytes& record) {
  std::uint32_t version = 0;
  std::memcpy(&version, record.data() + sizeof(std::uint64_t), sizeof version);
  return version;
}

TEST(SourceRecord, IsWhatItWasWhereNoSurfaceIsSmooth) {
  testing::Random random(kRecordSeed);
  ImportReport report = random_report(random);
  report.surface_error_m = 0.0;
  const Mesh mesh = mesh_of_objects(random, 2, 1.0);
  const Bytes before = record_of(*make_source(ObjectKind::kMesh, mesh, report, without_field()));
  EXPECT_EQ(version_of(before), 1U);
  report.surface_error_m = 0.125;
  const Bytes smooth = record_of(*make_source(ObjectKind::kMesh, mesh, report, without_field()));
  EXPECT_EQ(version_of(smooth), 2U);
  EXPECT_EQ(smooth.size(), before.size() + sizeof(double));
  const SourcePtr back = decoded(smooth);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->report.surface_error_m, 0.125);
}

TEST(SourceRecord, GivesBackAnyShape) {
  testing::Random random(kRecordSeed + 1);
  const std::vector<SourcePtr> sources = shape_samples(random);
  ASSERT_EQ(sources.size(), 7U);
  for (const SourcePtr& source : sources) {
    ASSERT_NO_FATAL_FAILURE(expect_same(source, decoded(record_of(*source))));
  }
}

TEST(SourceRecord, GivesBackAMapAfterAnyScan) {
  testing::Random random(kRecordSeed + 2);
  for (const UnknownSpace unknown : {UnknownSpace::kFree, UnknownSpace::kOccupied}) {
    const SourcePtr empty =
        source_of_map(VoxelMap::build(kSampleVoxel_m, {}, {}, unknown, {30'000, 70'000}).map);
    ASSERT_NO_FATAL_FAILURE(expect_equal(*empty, *decoded(record_of(*empty))));
    std::vector<SourcePtr> sources = scanned_samples(random, unknown);
    for (const std::size_t at : {0U, 1U, 10U}) {
      const SourcePtr& source = sources[at];
      const SourcePtr other = decoded(record_of(*source));
      ASSERT_NO_FATAL_FAILURE(expect_same(source, other));
      testing::Random same = random;
      const auto next = source_of_map(scanned_sample(random, *source->map_O, 20, 2.0));
      const auto other_next = source_of_map(scanned_sample(same, *other->map_O, 20, 2.0));
      ASSERT_NO_FATAL_FAILURE(expect_same(next, other_next)) << "the next scan finds another map";
    }
  }
}

TEST(SourceRecord, DifferencesGiveBackAllMapsOfASeries) {
  testing::Random random(kRecordSeed + 3);
  for (const UnknownSpace unknown : {UnknownSpace::kFree, UnknownSpace::kOccupied}) {
    const std::vector<SourcePtr> sources = scanned_samples(random, unknown);
    SourcePtr restored = decoded(record_of(*sources.front()));
    BlobId id = blob_id_of(record_of(*sources.front()));
    int differences = 0;
    for (std::size_t i = 1; i < sources.size(); ++i) {
      const Bytes whole = record_of(*sources[i]);
      const auto difference = record_of_difference(*sources[i], *sources[i - 1], id);
      EXPECT_EQ(record_of_difference(*sources[i], *restored, id), difference)
          << "it depends on what the maps share";
      const Bytes& record = difference ? *difference : whole;
      if (difference) {
        ++differences;
        // The comparison leaves out 300 bytes beside the blocks.
        EXPECT_LT(static_cast<double>(record.size()),
                  0.5 * static_cast<double>(whole.size()) + 300);
        ASSERT_EQ(*base_of_record(record), id);
        EXPECT_THAT(error_of(record), HasSubstr("missing"));
      }
      restored = decoded(record, difference ? restored : nullptr);
      ASSERT_NO_FATAL_FAILURE(expect_equal(*sources[i], *restored));
      ASSERT_EQ(record_of(*restored), whole);
      id = blob_id_of(record);
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(sources.back(), restored));
    EXPECT_GE(differences, 6) << "small scans have small records";
    EXPECT_FALSE(record_of_difference(*sources[1], *sources[0], id)) << "it is not small";
  }
}

TEST(SourceRecord, HasNoDifferenceWhereBlocksAreNotEnough) {
  testing::Random random(kRecordSeed + 4);
  const auto free = UnknownSpace::kFree;
  const SourcePtr before = scanned_samples(random, free).back();
  const VoxelMap& map = *before->map_O;
  const auto after = [&](double resolution_m, UnknownSpace unknown, const VoxelMapLimits& limits,
                         const SensorModel& sensor, const Voxel* left_out) {
    VoxelSet left;
    map.free().for_each([&](const Voxel& voxel) {
      if (left_out == nullptr || voxel != *left_out) left.insert(voxel);
    });
    const auto built =
        VoxelMap::build(resolution_m, map.occupied(), left, unknown, limits, sensor).map;
    const auto beliefs = map.blocks_changed_since(*built);
    std::vector<ScannedBlock> blocks;
    for (ScannedBlock block : beliefs) {
      block.free = left.block(block.key);
      blocks.push_back(block);
    }
    return record_of_difference(*source_of_map(built->with(blocks).map), *before, {}).has_value();
  };
  const double edge_m = map.resolution_m();
  EXPECT_TRUE(after(edge_m, free, map.limits(), map.sensor(), nullptr)) << "nothing differs";
  EXPECT_FALSE(after(2.0 * edge_m, free, map.limits(), map.sensor(), nullptr));
  EXPECT_FALSE(after(edge_m, UnknownSpace::kOccupied, map.limits(), map.sensor(), nullptr));
  EXPECT_FALSE(after(edge_m, free, {map.limits().voxels, 99'999}, map.sensor(), nullptr));
  EXPECT_FALSE(after(edge_m, free, {99'999, map.limits().triangles}, map.sensor(), nullptr));
  SensorModel sensor = map.sensor();
  sensor.max_range_m = 7.0;
  EXPECT_FALSE(after(edge_m, free, map.limits(), sensor, nullptr));
  Voxel only_free{};
  map.free().for_each([&](const Voxel& voxel) {
    if (!map.occupied().contains(voxel)) only_free = voxel;
  });
  EXPECT_FALSE(after(edge_m, free, map.limits(), map.sensor(), &only_free));
}

}  // namespace
}  // namespace camway::scene
