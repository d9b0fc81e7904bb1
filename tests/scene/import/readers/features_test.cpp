// SPDX-License-Identifier: MIT
//
// Features of the formats beyond plain triangles, and elements that are counted instead of read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/scene/import/readers/mesh_collector.h"
#include "daemon/scene/import/readers/mesh_reader.h"

namespace camway::scene::mesh_readers {
namespace {

using import_record::Record;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Record read(std::string_view extension, std::string_view text) {
  base::Result<Record> result = read_mesh(extension, text);
  EXPECT_EQ(result.error, "");
  return *std::move(result);
}

std::vector<std::string> names_of(const Record& record) {
  std::vector<std::string> names;
  std::size_t at = 0;
  for (const import_record::Object& object : record.objects) {
    names.push_back(record.names.substr(at, object.name_bytes) + ":" +
                    std::to_string(object.triangles));
    at += object.name_bytes;
  }
  return names;
}

constexpr std::string_view kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string obj(std::string_view rest) { return std::string(kCorners) + std::string(rest); }

TEST(ObjReader, NamesObjectsAsAssimpDoes) {
  EXPECT_THAT(names_of(read(".obj", obj("f 1 2 3\n"))), ElementsAre("defaultobject:1"));
  EXPECT_THAT(names_of(read(".obj", obj("o one two\nf 1 2 3\ng  left  side \nf 1 2 3 4\n"))),
              ElementsAre("one:1", "left  side:2"));
  // A material divides an object only if the material before has faces in it.
  EXPECT_THAT(names_of(read(".obj", obj("o a\nusemtl red\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl "
                                        "blue\nf 1 2 3\nf 1 2 4\nusemtl red\no b\nf 1 2 3\n"))),
              ElementsAre("a:2", "a/blue:2", "b:1"));
  EXPECT_THAT(names_of(read(".obj", obj("o a\nf 1 2 3\nusemtl red\nf 1 2 3\n"))),
              ElementsAre("a:2"));
  EXPECT_THAT(names_of(read(".obj", obj("g x\nf 1 2 3\ng x\nf 1 2 4\no empty\ng x\nf 2 3 4\n"))),
              ElementsAre("x:2", "empty:1"));
}

TEST(ObjReader, ResolvesIndicesFromEitherEnd) {
  // An index relative to the vertices so far; an absolute one may lie ahead.
  const Record record = read(".obj",
                             "v 0 0 0\nv 1 0 0\nv 2 0 0\nf -3 -2 -1\nf 1 2 4\nv 3 0 0\nf -1 "
                             "-2 -4\n");
  EXPECT_THAT(record.triangles,
              ElementsAre(import_record::Triangle{0, 1, 2}, import_record::Triangle{0, 1, 3},
                          import_record::Triangle{3, 2, 0}));
}

TEST(ObjReader, DividesByWeightsAndPassesOverColours) {
  const Record record = read(".obj",
                             "v 1 2 3 2\nv 1 2 3 0.1 0.2 0.3\nv 1 2 3 1 0 0 1\nv 1 2 3 0\n"
                             "v 1 2\nv 1 x 3\nv 1 2 3 # 4\n");
  EXPECT_THAT(record.vertices[0], ElementsAre(0.5, 1.0, 1.5));
  for (const std::size_t i : {1U, 2U, 6U}) {
    EXPECT_THAT(record.vertices[i], ElementsAre(1.0, 2.0, 3.0)) << i;
  }
  EXPECT_TRUE(std::isinf(record.vertices[3][0]));
  EXPECT_TRUE(std::isnan(record.vertices[4][0]));
  EXPECT_TRUE(std::isnan(record.vertices[5][1]));
}

TEST(ObjReader, CountsWhatIsNoSurface) {
  const Record record =
      read(".obj", obj("p 1 2 3\nl 1 2 3 4\nf 1 2\nf 1\nf\nsurf 0 1 0 1 1 2 3 4\n"));
  EXPECT_EQ(record.header.dropped_points_and_lines, 3U + 3U + 1U + 1U);
  EXPECT_EQ(record.header.dropped_freeform, 1U);
  EXPECT_THAT(names_of(record), ElementsAre(":0"));
}

TEST(ObjReader, CountsWhatNoReaderKnows) {
  const Record record = read(
      ".obj", obj("# F\nmtllib a.mtl\ns 1\nvn 0 0 1\nF 1 2 3\nf1 2 3\ncall b.obj\nbzp 1 2 3\n"));
  EXPECT_EQ(record.header.ignored_statements, 3U);
  EXPECT_EQ(record.header.dropped_freeform, 1U);
}

// Faces beyond the announced number would be lost silently, and a path through them certified.
TEST(Headers, MustNotPromiseLessThanThereIs) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_mesh(".off", off + " # the end\n\n").error, "");
  EXPECT_THAT(read_mesh(".off", off + "3 0 2 1\n").error, HasSubstr("goes on after the 1 faces"));
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_mesh(".ply", ply + " \n").error, "");
  EXPECT_THAT(read_mesh(".ply", ply + "3 0 2 1\n").error, HasSubstr("goes on after"));
  std::string stl(80, ' ');
  stl += std::string("\1\0\0\0", 4) + std::string(50, '\0');
  EXPECT_EQ(read_mesh(".stl", stl + std::string(3, '\0')).error, "");
  EXPECT_THAT(read_mesh(".stl", stl + std::string(50, 'x')).error,
              HasSubstr("goes on after the 1 facets"));
}

TEST(ObjReader, JoinsLinesAndKnowsAllLineEnds) {
  for (const std::string& text :
       {std::string("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3"),
        std::string(
            "\xef\xbb\xbfv 0 0 \\\r\n 0\r\nv 1 0 0\r\n\r\n  v 0 1 0\r\nf \\\r\n1 \\\r\n2 3\\"),
        std::string("v 0 0 0\nv 1 0 0\nv 0 1 0 \nf 1\\\n 2 3\n")}) {
    EXPECT_THAT(read(".obj", text).triangles, ElementsAre(import_record::Triangle{0, 1, 2}));
  }
}

TEST(Polygons, WithABadCornerAreCountedNotGuessed) {
  const Record record =
      read(".obj", obj("f 1 2 3 9\nv nan 0 0\nf 1 2 5 3\nv 1e70 0 0\nf 1 2 6 3\n"));
  ASSERT_EQ(record.triangles.size(), 5U);
  EXPECT_THAT(record.triangles[0], ElementsAre(kNoVertex, kNoVertex, kNoVertex));
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_THAT(record.triangles[i], ::testing::Contains(i < 3 ? 4U : 5U)) << i;
  }
}

TEST(OffReader, TakesHeadersAsTheyAreFound) {
  for (const std::string_view header :
       {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF\n3 1\n", "OFF3 1 0\n", "3 1 0\n",
        "OFF\n# c\n\n3\n1\n0\n", "# c\nOFF # c\n3 1 0 # c\n", "COFF\n3 1 0\n", "nOFF 3\n3 1 0\n"}) {
    SCOPED_TRACE(header);
    const Record record = read(".off", std::string(header) + "0 0 0\n1 0 0\n\n0 1 0 # c\n3 0 1 2");
    EXPECT_THAT(record.triangles, ElementsAre(import_record::Triangle{0, 1, 2}));
    EXPECT_THAT(names_of(record), ElementsAre("<OFFRoot>:1"));
  }
  const Record weighted = read(".off", "4OFF\n3 2 0\n2 4 6 2\n1 0 0 1\n0 1 0 1\n3 0 1 2\n2 0 1\n");
  EXPECT_THAT(weighted.vertices[0], ElementsAre(1.0, 2.0, 3.0));
  EXPECT_EQ(weighted.header.dropped_points_and_lines, 1U);
}

TEST(PlyReader, ReadsStripsAndCountsEdgesAndClouds) {
  const std::string vertices =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const Record strips =
      read(".ply", "ply\nformat ascii 1.0\n" + vertices +
                       "element tristrips 1\nproperty list int int vertex_indices\nelement edge 2\n"
                       "property int vertex1\nproperty int vertex2\nend_header\n" +
                       points + "8 0 1 2 3 -1 1 2 3\n0 1\n1 2\n");
  EXPECT_THAT(strips.triangles,
              ElementsAre(import_record::Triangle{0, 1, 2}, import_record::Triangle{1, 3, 2},
                          import_record::Triangle{1, 2, 3}));
  EXPECT_EQ(strips.header.dropped_points_and_lines, 2U);
  const Record cloud =
      read(".ply",
           "ply\r\nformat ascii 1.0\r\nelement nothing 7\r\nelement vertex 4\r\nproperty "
           "float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n" +
               points);
  EXPECT_EQ(cloud.header.dropped_points_and_lines, 4U);
}

TEST(StlReader, TellsBinaryFromText) {
  std::string binary = "solid but binary";
  binary.resize(84 + 50);
  binary[80] = 1;
  const Record record = read(".stl", binary);
  EXPECT_EQ(record.text, "STL, binary");
  EXPECT_THAT(names_of(record), ElementsAre(":1"));
  const std::string facet =
      "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
      "0\nENDLOOP\nENDFACET\n";
  const Record text =
      read(".stl", "Solid a name\n" + facet + facet + "endsolid\nsolid b\n" + facet);
  EXPECT_EQ(text.text, "STL, text");
  EXPECT_THAT(names_of(text), ElementsAre("a:2", "b:1"));
}

}  // namespace
}  // namespace camway::scene::mesh_readers
