// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/cache_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/scene/cache/prepared_matchers.h"
#include "tests/scene/cache/prepared_samples.h"
#include "tests/support/case_name.h"
#include "tests/support/scenes.h"

namespace camway::scene {
namespace {

namespace layout = cache_layout;
using testing::expect_same;
using testing::file_of;
using testing::read_bytes;
using testing::small_prepared;
using testing::values_in;

TEST(CacheFile, KeepsEveryBit) {
  testing::Random random(20261125);
  for (const int triangles : {1, 17, 3000}) {
    SCOPED_TRACE(triangles);
    Mesh mesh = testing::scattered_triangles(random, triangles, 0.1);
    mesh.vertices[0].x() = -0.0;
    mesh.objects = {{"all", 0, static_cast<std::uint32_t>(triangles)}};
    const PreparedScene written = testing::prepared_of(*make_snapshot("s", mesh).snapshot);
    const base::Result<PreparedScene> read = read_bytes(file_of(written));
    ASSERT_TRUE(read) << read.error;
    expect_same(written, *read);
  }
}

TEST(CacheFile, KeepsAReportOtherThanTheUsual) {
  PreparedScene written = small_prepared(true);
  ImportReport& report = written.report;
  report.format = "PLY, text";
  report.degenerate_triangles = 1;
  report.dropped_nonfinite = 2;
  report.dropped_bad_index = 3;
  report.dropped_points_and_lines = 4;
  report.dropped_freeform = 5;
  report.ignored_statements = 6;
  report.single_precision = true;
  report.rounding_m = 0.25;
  report.surface_error_m = 0.125;
  const base::Result<PreparedScene> read = read_bytes(file_of(written));
  ASSERT_TRUE(read) << read.error;
  expect_same(written, *read);
}

TEST(CacheFile, HasTheSameBytesForTheSameScene) {
  EXPECT_EQ(file_of(small_prepared(true)), file_of(small_prepared(true)));
}

class DamagedCacheFile : public ::testing::TestWithParam<bool> {};

TEST_P(DamagedCacheFile, GivesTheSceneOrNothingAfterEachFlippedByte) {
  const PreparedScene written = small_prepared(GetParam());
  std::vector<std::uint8_t> bytes = file_of(written);
  std::size_t accepted = 0;
  for (std::uint8_t& byte : bytes) {
    byte ^= 0x40U;
    const base::Result<PreparedScene> read = read_bytes(bytes);
    byte ^= 0x40U;
    if (!read) continue;
    ++accepted;
    expect_same(written, *read);
  }
  // The gaps between sections are the only bytes that nothing depends on.
  EXPECT_LT(accepted, layout::kAlignment * layout::kSectionCount);
}

TEST_P(DamagedCacheFile, GivesNothingAtAnyShorterLength) {
  const std::vector<std::uint8_t> bytes = file_of(small_prepared(GetParam()));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(read_bytes(std::span(bytes).first(size))) << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Field, DamagedCacheFile, ::testing::Bool());

TEST(CacheFile, IsForItsOwnKeyOnly) {
  std::vector<std::uint8_t> bytes = file_of(small_prepared(false));
  reinterpret_cast<layout::Header*>(bytes.data())->key[0] ^= 1U;
  testing::reseal(bytes);
  EXPECT_FALSE(read_bytes(bytes));
}

TEST(CacheFile, IsForItsOwnBuildOnly) {
  std::vector<std::uint8_t> bytes = file_of(small_prepared(false));
  reinterpret_cast<layout::Header*>(bytes.data())->build[0] = 'x';
  testing::reseal(bytes);
  EXPECT_FALSE(read_bytes(bytes));
}

/// A file with right digests and one value that no prepared scene has.
struct Forgery {
  const char* name;
  void (*forge)(std::span<std::uint8_t>);
};

template <class Value>
Value& first_of(std::span<std::uint8_t> bytes, layout::SectionName name) {
  return values_in<Value>(bytes, name).front();
}
layout::Metadata& metadata_of(std::span<std::uint8_t> bytes) {
  return first_of<layout::Metadata>(bytes, layout::kMetadata);
}
std::span<IndexNode> nodes_of(std::span<std::uint8_t> bytes) {
  return values_in<IndexNode>(bytes, layout::kNodes);
}
std::span<std::uint32_t> numbers_of(std::span<std::uint8_t> bytes, layout::SectionName name) {
  return values_in<std::uint32_t>(bytes, name);
}

class ForgedCacheFile : public ::testing::TestWithParam<Forgery> {};

TEST_P(ForgedCacheFile, GivesNothing) {
  std::vector<std::uint8_t> bytes = file_of(small_prepared(true));
  testing::reseal(bytes);
  ASSERT_TRUE(read_bytes(bytes)) << "resealing alone changes nothing";
  ASSERT_GT(nodes_of(bytes)[0].node_count, 0U);
  ASSERT_GT(nodes_of(bytes).back().first_leaf, 0U);
  GetParam().forge(bytes);
  testing::reseal(bytes);
  EXPECT_FALSE(read_bytes(bytes));
}

using Bytes = std::span<std::uint8_t>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

const Forgery kForgeries[] = {
    {"VertexThatDoesNotExist",
     [](Bytes b) {
       numbers_of(b, layout::kTriangles)[4] =
           static_cast<std::uint32_t>(values_in<geometry::Vec3>(b, layout::kVertices).size());
     }},
    {"TriangleWithoutArea",
     [](Bytes b) {
       const std::span<std::uint32_t> corners = numbers_of(b, layout::kTriangles);
       corners[0] = corners[1];
     }},
    {"CoordinateThatIsNoNumber", [](Bytes b) { first_of<double>(b, layout::kVertices) = kNan; }},
    {"CoordinateTooLarge", [](Bytes b) { first_of<double>(b, layout::kVertices) = 0x1p200; }},
    {"MovedVertex", [](Bytes b) { first_of<double>(b, layout::kVertices) = -50.0; }},
    {"MeshBounds", [](Bytes b) { metadata_of(b).mesh_bounds_m[3] += 1.0; }},
    {"TreeBounds", [](Bytes b) { metadata_of(b).tree_bounds_m[0] = kNan; }},
    {"ObjectWithMoreTriangles",
     [](Bytes b) { first_of<layout::Object>(b, layout::kObjects).triangles += 1; }},
    {"ObjectWithoutTriangles",
     [](Bytes b) {
       const auto objects = values_in<layout::Object>(b, layout::kObjects);
       objects[1].triangles += objects[0].triangles;
       objects[0].triangles = 0;
     }},
    {"LongName", [](Bytes b) { first_of<layout::Object>(b, layout::kObjects).name_bytes = 4000; }},
    {"LongText", [](Bytes b) { metadata_of(b).file_bytes = ~std::uint64_t{0}; }},
    {"TextThatNobodyPrints", [](Bytes b) { first_of<char>(b, layout::kText) = '\n'; }},
    {"DigestThatIsNone", [](Bytes b) { metadata_of(b).digest_bytes -= 1; }},
    {"RoundingThatIsNoNumber", [](Bytes b) { metadata_of(b).rounding_m = kNan; }},
    {"NegativeSurfaceError", [](Bytes b) { metadata_of(b).surface_error_m = -1.0; }},
    {"SurfaceErrorThatIsNoNumber", [](Bytes b) { metadata_of(b).surface_error_m = kNan; }},
    {"NegativeRounding", [](Bytes b) { metadata_of(b).rounding_m = -1.0; }},
    {"FieldOfOtherCells", [](Bytes b) { metadata_of(b).field_resolution_m *= 0.5; }},
    {"FieldWithoutCells", [](Bytes b) { metadata_of(b).field_resolution_m = 0.0; }},
    {"FieldThatIsNoNumber", [](Bytes b) { metadata_of(b).field_resolution_m = kNan; }},
    {"ShareAboveOne", [](Bytes b) { metadata_of(b).field_settled_share = 1.5; }},
    {"FieldAndReasonWhyNot",
     [](Bytes b) {
       metadata_of(b).why_no_field_bytes = 1;
       first_of<layout::Object>(b, layout::kObjects).name_bytes -= 1;
     }},
    {"DeepTree", [](Bytes b) { metadata_of(b).tree_depth = kMaxIndexDepth + 1; }},
    {"TriangleThatDoesNotExist", [](Bytes b) { numbers_of(b, layout::kReferences).front() = 72; }},
    {"LeafThatBeginsBeforeTheOneBefore",
     [](Bytes b) { numbers_of(b, layout::kLeafBegin)[1] = 4'000'000; }},
    {"LeafThatBeginsLater", [](Bytes b) { numbers_of(b, layout::kLeafBegin)[0] = 1; }},
    {"LeafWithoutTriangles",
     [](Bytes b) {
       const std::span<std::uint32_t> begin = numbers_of(b, layout::kLeafBegin);
       begin[1] = begin[0];
     }},
    {"LastLeafThatEndsElsewhere", [](Bytes b) { numbers_of(b, layout::kLeafBegin).back() += 1; }},
    {"NodeThatIsItsOwnChild", [](Bytes b) { nodes_of(b)[0].first_node = 0; }},
    {"ChildThatDoesNotExist", [](Bytes b) { nodes_of(b)[0].first_node = 4'000'000; }},
    {"LeafThatDoesNotExist", [](Bytes b) { nodes_of(b).back().first_leaf = 4'000'000; }},
    {"TwoParents", [](Bytes b) { nodes_of(b).back().first_leaf = 0; }},
    {"NineChildren", [](Bytes b) { nodes_of(b)[0].child_count = 9; }},
    {"NoChildren", [](Bytes b) { nodes_of(b).back().child_count = 0; }},
    {"MoreNodesThanChildren", [](Bytes b) { nodes_of(b).back().node_count = 8; }},
    {"StepsTooLong", [](Bytes b) { nodes_of(b)[0].frame.exponent[1] = 1000; }},
    {"StepsTooShort", [](Bytes b) { nodes_of(b)[0].frame.exponent[2] = -1000; }},
    {"FourthStep", [](Bytes b) { nodes_of(b)[0].frame.exponent[3] = 1; }},
    {"NodeNowhere", [](Bytes b) { nodes_of(b)[0].frame.origin[0] = kInf; }},
    {"SectionBeyondTheFile",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kBoxes].offset =
           ~std::uint64_t{63};
     }},
    {"SectionThatIsTooLong",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kNodes].bytes = 96ULL << 50U;
     }},
    {"SectionBetweenValues",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kVertices].offset += 4;
     }},
    {"NoFacts",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kMetadata].bytes = 0;
     }},
    {"NoTree",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kNodes].bytes = 0;
     }},
    {"NoLeaves",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kLeafBegin].bytes = 0;
     }},
    {"FewerBoxes",
     [](Bytes b) {
       reinterpret_cast<layout::Header*>(b.data())->sections[layout::kBoxes].bytes -= 48;
     }},
};

INSTANTIATE_TEST_SUITE_P(All, ForgedCacheFile, ::testing::ValuesIn(kForgeries),
                         testing::name_of_case);

}  // namespace
}  // namespace camway::scene
