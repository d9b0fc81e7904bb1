// SPDX-License-Identifier: MIT
#include "daemon/scene/import/record/import_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {
namespace {

namespace layout = import_record;
using geometry::Vec3;
using ::testing::ElementsAre;

/// A record as the import process writes it, in which every part may be wrong.
struct Forged {
  layout::Header header;
  std::string text = "test format";
  std::string notes = "one note\nanother\x01 note\n";
  std::vector<layout::Vertex> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<layout::Triangle> triangles = {{0, 1, 2}, {0, 1, 3}};
  std::vector<layout::Object> objects = {{1, 3}, {1, 3}};
  std::string names = "onetwo";

  Forged() {
    header.text_bytes = text.size();
    header.note_bytes = notes.size();
    header.vertices = vertices.size();
    header.triangles = triangles.size();
    header.objects = objects.size();
    header.name_bytes = names.size();
  }

  [[nodiscard]] std::vector<std::byte> bytes() const {
    std::vector<std::byte> result;
    const auto append = [&](const void* data, std::size_t size) {
      const auto* begin = static_cast<const std::byte*>(data);
      result.insert(result.end(), begin, begin + size);
    };
    append(&header, sizeof header);
    append(text.data(), text.size());
    append(notes.data(), notes.size());
    append(vertices.data(), vertices.size() * sizeof vertices[0]);
    append(triangles.data(), triangles.size() * sizeof triangles[0]);
    append(objects.data(), objects.size() * sizeof objects[0]);
    append(names.data(), names.size());
    return result;
  }
};

TEST(ImportRecord, GivesBackWhatWasWritten) {
  ImportReport report;
  const ImportRecordResult result = read_import_record(Forged().bytes(), {}, report);
  ASSERT_TRUE(result.mesh);
  EXPECT_FALSE(result.broken);
  EXPECT_EQ(report.format, "test format");
  EXPECT_THAT(report.notes, ElementsAre("one note", "another? note"));
  EXPECT_EQ(result.mesh->triangles.size(), 2U);
  EXPECT_EQ(result.mesh->triangle(1)[2], Vec3(0, 0, 1));
  ASSERT_EQ(result.mesh->objects.size(), 2U);
  EXPECT_EQ(result.mesh->objects[1].name, "two");
  EXPECT_EQ(result.mesh->objects[1].first_triangle, 1U);
}

TEST(ImportRecord, EveryTruncationIsBroken) {
  const std::vector<std::byte> whole = Forged().bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ImportReport report;
    const ImportRecordResult result = read_import_record(std::span(whole).first(size), {}, report);
    EXPECT_TRUE(result.broken) << size;
    EXPECT_FALSE(result.mesh);
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  ImportReport report;
  EXPECT_TRUE(read_import_record(longer, {}, report).broken);
}

TEST(ImportRecord, NoCountIsBelieved) {
  // 2^60 elements of 12 or 16 bytes overflow a product of 64 bits.
  for (const std::uint64_t count :
       {std::uint64_t{5}, std::uint64_t{1} << 32, std::uint64_t{1} << 60,
        std::numeric_limits<std::uint64_t>::max()}) {
    for (std::uint64_t layout::Header::*member :
         {&layout::Header::text_bytes, &layout::Header::note_bytes, &layout::Header::vertices,
          &layout::Header::triangles, &layout::Header::objects, &layout::Header::name_bytes}) {
      Forged forged;
      forged.header.*member = count;
      ImportReport report;
      EXPECT_TRUE(read_import_record(forged.bytes(), {}, report).broken);
    }
  }
  Forged forged;
  forged.header.magic ^= 1;
  ImportReport report;
  EXPECT_TRUE(read_import_record(forged.bytes(), {}, report).broken);
}

TEST(ImportRecord, ARoundingThatIsNoBoundIsBroken) {
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (double layout::Header::*member :
         {&layout::Header::relative_rounding, &layout::Header::absolute_rounding,
          &layout::Header::surface_error}) {
      Forged forged;
      forged.header.*member = bad;
      ImportReport report;
      EXPECT_TRUE(read_import_record(forged.bytes(), {}, report).broken);
    }
  }
}

TEST(ImportRecord, BadIndicesAreDroppedAndCounted) {
  for (const std::uint32_t bad : {4U, 99'999'999U, std::numeric_limits<std::uint32_t>::max()}) {
    for (std::size_t k = 0; k < 3; ++k) {
      Forged forged;
      forged.triangles[0][k] = bad;
      ImportReport report;
      const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
      ASSERT_TRUE(result.mesh);
      EXPECT_EQ(result.mesh->triangles.size(), 1U);
      EXPECT_EQ(report.dropped_bad_index, 1U);
      // The object that lost its triangle is gone, and the other one has its index.
      ASSERT_EQ(result.mesh->objects.size(), 1U);
      EXPECT_EQ(result.mesh->objects[0].name, "two");
      EXPECT_EQ(result.mesh->objects[0].first_triangle, 0U);
    }
  }
}

TEST(ImportRecord, CoordinatesThatAreNoNumberAreDroppedAndCounted) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Forged forged;
    forged.vertices[3][1] = bad;
    ImportReport report;
    const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
    ASSERT_TRUE(result.mesh);
    EXPECT_EQ(result.mesh->triangles.size(), 1U);
    EXPECT_EQ(result.mesh->vertices.size(), 3U);
    EXPECT_EQ(report.dropped_nonfinite, 1U);
  }
  // Finite in the file, but too large after scaling.
  Forged forged;
  forged.vertices[3][2] = 1e38;
  ImportReport report;
  EXPECT_EQ(read_import_record(forged.bytes(), {.scale = 1e30}, report).mesh->triangles.size(), 1U);
  EXPECT_EQ(report.dropped_nonfinite, 1U);
}

TEST(ImportRecord, TheUnitOfTheFileMultipliesTheScale) {
  Forged forged;
  forged.header.unit_m = 0.5;
  ImportReport report;
  const ImportRecordResult result = read_import_record(forged.bytes(), {.scale = 4.0}, report);
  EXPECT_EQ(result.mesh->triangle(0)[1], Vec3(2, 0, 0));
  EXPECT_EQ(report.scale, 2.0);
  EXPECT_EQ(report.unit_m, 0.5);
  for (const double bad : {-1.0, 1e-300, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    forged.header.unit_m = bad;
    EXPECT_TRUE(read_import_record(forged.bytes(), {}, report).broken) << bad;
  }
}

TEST(ImportRecord, ObjectsThatClaimTooMuchGetWhatThereIs) {
  Forged forged;
  forged.objects = {{1000, 1000}, {5, 7}};
  ImportReport report;
  const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
  ASSERT_TRUE(result.mesh);
  ASSERT_EQ(result.mesh->objects.size(), 1U);
  EXPECT_EQ(result.mesh->objects[0].triangle_count, 2U);
  EXPECT_EQ(result.mesh->objects[0].name, "onetwo");
}

TEST(ImportRecord, TrianglesThatNoObjectClaimsAreStillThere) {
  Forged forged;
  forged.objects[1].triangles = 0;
  ImportReport report;
  const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
  ASSERT_TRUE(result.mesh);
  EXPECT_EQ(result.mesh->triangles.size(), 2U);
  std::uint32_t covered = 0;
  for (const MeshObject& object : result.mesh->objects) {
    EXPECT_EQ(object.first_triangle, covered);
    covered += object.triangle_count;
  }
  EXPECT_EQ(covered, 2U);
}

TEST(ImportRecord, NamesAreMadePrintable) {
  Forged forged;
  forged.names = "\n\x1b\xfftwo";
  ImportReport report;
  const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
  ASSERT_TRUE(result.mesh);
  EXPECT_EQ(result.mesh->objects[0].name, "???");
}

TEST(ImportRecord, ARefusalCarriesItsReason) {
  Forged forged;
  forged.text = "no good\n";
  forged.notes.clear();
  forged.vertices.clear();
  forged.triangles.clear();
  forged.objects.clear();
  forged.names.clear();
  forged.header = {};
  forged.header.text_bytes = forged.text.size();
  ImportReport report;
  const ImportRecordResult result = read_import_record(forged.bytes(), {}, report);
  EXPECT_FALSE(result.broken);
  EXPECT_FALSE(result.mesh);
  EXPECT_EQ(result.refusal, "no good?");
}

}  // namespace
}  // namespace camway::scene
