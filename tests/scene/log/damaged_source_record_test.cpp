// SPDX-License-Identifier: MIT
//
// Records that cannot be, and records that were damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "tests/scene/log/source_samples.h"

namespace camway::scene {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kDamageSeed = 90422;

/// Small enough that no damaged record may ask for much memory.
constexpr VoxelMapLimits kUsualLimits{};

TEST(DamagedSourceRecord, RefusesAnotherBase) {
  testing::Random random(kDamageSeed);
  const std::vector<SourcePtr> sources = scanned_samples(random, UnknownSpace::kFree);
  const auto difference = record_of_difference(*sources[10], *sources[9], {});
  ASSERT_TRUE(difference);
  EXPECT_THAT(error_of(*difference, sources[0]), HasSubstr("another map"));
  EXPECT_THAT(error_of(*difference, sources[4]), HasSubstr("another map"));
  EXPECT_THAT(error_of(*difference, shape_samples(random).front()), HasSubstr("missing"));
}

TEST(DamagedSourceRecord, RefusesMapsBeyondTheLargestLimits) {
  testing::Random random(kDamageSeed + 1);
  const Bytes record = record_of(*source_of_map(map_sample(random, UnknownSpace::kFree, 5)));
  const auto error = [&](const VoxelMapLimits& largest) {
    return source_from(record, nullptr, without_field(), largest).error;
  };
  EXPECT_EQ(error(kUsualLimits), "");
  EXPECT_THAT(error({kUsualLimits.voxels - 1, kUsualLimits.triangles}), HasSubstr("limits"));
  EXPECT_THAT(error({kUsualLimits.voxels, kUsualLimits.triangles - 1}), HasSubstr("limits"));
}

TEST(DamagedSourceRecord, RefusesMapsThatCannotBe) {
  VoxelSet voxels;
  voxels.insert(Voxel{1, 2, 3});
  const auto error_of_map = [&](const VoxelSet& occupied, const VoxelMapLimits& limits,
                                const SensorModel& sensor, float belief) {
    ObjectSource source;
    source.kind = ObjectKind::kMap;
    source.map_O =
        VoxelMap::build(kSampleVoxel_m, occupied, {}, UnknownSpace::kFree, limits, sensor).map;
    Beliefs beliefs{};
    beliefs[7] = belief;
    const std::uint64_t key =
        BlockKey::of(occupied.bounds()[0].first > 9 ? Voxel{32768, 2, 3} : Voxel{1, 2, 3});
    const ScannedBlock block{key, occupied.block(key), {}, std::make_shared<Beliefs>(beliefs)};
    source.map_O = source.map_O->with(std::span(&block, 1)).map;
    return error_of(record_of(source));
  };
  EXPECT_EQ(error_of_map(voxels, {}, {}, -0.0F), "");
  for (const float belief :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    EXPECT_THAT(error_of_map(voxels, {}, {}, belief), HasSubstr("blocks"));
  }
  EXPECT_THAT(error_of_map(voxels, {1, 11}, {}, 0.0F), HasSubstr("allow no map"));
  SensorModel sensor;
  sensor.miss_probability = 0.5;
  EXPECT_THAT(error_of_map(voxels, {}, sensor, 0.0F), HasSubstr("miss_probability"));
  VoxelSet outside;
  outside.insert(Voxel{32768, 2, 3});
  EXPECT_THAT(error_of_map(outside, {}, {}, 0.0F), HasSubstr("blocks"));
  voxels.insert(Voxel{3, 2, 3});
  EXPECT_THAT(error_of_map(voxels, {2, 23}, {}, 0.0F), HasSubstr("triangles"));
}

struct SmallRecord {
  Bytes bytes;
  SourcePtr base;
};

/// Returns a small record of each form.
std::vector<SmallRecord> small_records(testing::Random& random) {
  std::vector<SmallRecord> records;
  records.push_back({record_of(*make_source(ObjectKind::kMesh, mesh_of_objects(random, 4, 1e3),
                                            random_report(random), without_field())),
                     nullptr});
  records.push_back({record_of(*shape_samples(random).front()), nullptr});
  for (const UnknownSpace unknown : {UnknownSpace::kFree, UnknownSpace::kOccupied}) {
    const SourcePtr map = source_of_map(map_sample(random, unknown, 3));
    records.push_back({record_of(*map), nullptr});
    const SourcePtr next = source_of_map(scanned_sample(random, *map->map_O, 1, 0.3));
    records.push_back({record_of(*next), nullptr});
    records.push_back({record_of(*source_of_map(map->map_O, {0.25, -3.0, 1e5})), nullptr});
    const SourcePtr base = source_of_map(scanned_sample(random, *map->map_O, 30, 1.5));
    const SourcePtr last = source_of_map(scanned_sample(random, *base->map_O, 1, 0.3));
    const auto difference = record_of_difference(*last, *base, blob_id_of({}));
    EXPECT_TRUE(difference);
    if (difference) records.push_back({*difference, base});
  }
  return records;
}

TEST(DamagedSourceRecord, RefusesWhatIsTooShortOrTooLong) {
  testing::Random random(kDamageSeed + 2);
  for (const SmallRecord& record : small_records(random)) {
    ASSERT_EQ(error_of(record.bytes, record.base), "");
    for (std::size_t size = 0; size < record.bytes.size(); ++size) {
      const Bytes bytes(record.bytes.begin(),
                        record.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_NE(error_of(bytes, record.base), "") << size << " of " << record.bytes.size();
    }
    Bytes longer = record.bytes;
    longer.emplace_back();
    EXPECT_NE(error_of(longer, record.base), "");
  }
}

/// A whole record that is accepted is the only one of its source, so nothing in it was overlooked.
TEST(DamagedSourceRecord, ReadsOrRefusesWhatIsDamaged) {
  testing::Random random(kDamageSeed + 3);
  const std::vector<SmallRecord> records = small_records(random);
  int read = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const SmallRecord& record = records[static_cast<std::size_t>(trial) % records.size()];
    Bytes bytes = record.bytes;
    // Half of them near the front, where the counts are.
    const std::size_t most =
        trial % 16 < 8 ? std::min<std::size_t>(300, bytes.size()) : bytes.size();
    bytes[random() % most] ^= std::byte{static_cast<unsigned char>(random.integer(1, 255))};
    const base::Result<SourcePtr> result =
        source_from(bytes, record.base, without_field(), kUsualLimits);
    ASSERT_EQ(static_cast<bool>(result), result.error.empty());
    if (!result) continue;
    ++read;
    const Bytes again = record_of(**result);
    if (!record.base) {
      ASSERT_EQ(again, bytes);
    }
    ASSERT_EQ(record_of(*decoded(again)), again);
  }
  EXPECT_GT(read, kTrials / 20);
  EXPECT_LT(read, kTrials - kTrials / 20);
}

TEST(DamagedSourceRecord, SaysWhatIsWrong) {
  testing::Random random(kDamageSeed + 4);
  EXPECT_THAT(error_of({}), HasSubstr("no content of an object"));
  const Bytes record = small_records(random)[0].bytes;
  Bytes newer = record;
  newer[8] = std::byte{4};
  EXPECT_THAT(error_of(newer), HasSubstr("version 4"));
  EXPECT_THAT(base_of_record(newer).error, HasSubstr("version 4"));
  Bytes odd = record;
  odd[12] = std::byte{6};
  EXPECT_THAT(error_of(odd), HasSubstr("header"));
  const auto error_of_mesh = [](auto change) {
    Mesh mesh = *box_mesh({1.0, 1.0, 1.0});
    const ImportReport report = report_of(mesh, "OBJ");
    const SourcePtr sound = make_source(ObjectKind::kMesh, mesh, report, without_field());
    ObjectSource source = *sound;
    change(source, mesh);
    source.parts_O[0].mesh = std::make_shared<const Mesh>(mesh);
    return error_of(record_of(source));
  };
  EXPECT_EQ(error_of_mesh([](ObjectSource&, Mesh&) {}), "");
  EXPECT_THAT(error_of_mesh([](auto&, Mesh& mesh) { mesh.triangles[0][1] = 8; }),
              HasSubstr("mesh"));
  EXPECT_THAT(error_of_mesh([](ObjectSource& source, Mesh& mesh) {
                source.kind = ObjectKind::kBox;
                mesh.triangles[0][1] = 8;
              }),
              HasSubstr("does not exist"));
  EXPECT_THAT(error_of_mesh([](auto&, Mesh& mesh) {
                mesh.triangles[0] = {0, 0, 1};
              }),
              HasSubstr("no area"));
  EXPECT_THAT(error_of_mesh([](auto&, Mesh& mesh) {
                mesh.vertices[7].z() = std::numeric_limits<double>::infinity();
              }),
              HasSubstr("not finite"));
  EXPECT_THAT(error_of_mesh([](auto&, Mesh& mesh) { --mesh.objects[0].triangle_count; }),
              HasSubstr("objects"));
  EXPECT_THAT(error_of_mesh([](auto&, Mesh& mesh) { mesh.objects[0].name = "a\n"; }),
              HasSubstr("texts"));
  EXPECT_THAT(error_of_mesh([](ObjectSource& source, Mesh&) { source.report.scale = 0.0; }),
              HasSubstr("report"));
}

}  // namespace
}  // namespace camway::scene
