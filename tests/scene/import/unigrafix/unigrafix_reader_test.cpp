// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace camway::scene::unigrafix {
namespace {

using import_record::Record;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
using Vertex = import_record::Vertex;
using Files = std::map<std::string, std::string>;

base::Result<Record> read(const std::string& text, const Files& files = {},
                          std::uint64_t most = kMostVerticesAndFaces) {
  return read_unigrafix(
      text,
      [&](const std::string& from, const std::string& name) -> base::Result<IncludedFile> {
        const auto found = files.find(name);
        if (found == files.end()) return base::Failure{"is not there"};
        return IncludedFile{(from.empty() ? "" : from + ">") + name, found->second};
      },
      most);
}

Record sound(const std::string& text, const Files& files = {}) {
  base::Result<Record> result = read(text, files);
  EXPECT_EQ(result.error, "");
  return result ? *std::move(result) : Record{};
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

/// The corners of all triangles.
std::vector<Vertex> corners_of(const Record& record) {
  std::vector<Vertex> corners;
  for (const auto& triangle : record.triangles) {
    for (const std::uint32_t corner : triangle) corners.push_back(record.vertices[corner]);
  }
  return corners;
}

const std::string kSquare = "v a 0 0 0; v b 1 0 0; v c 1 1 0; v d 0 1 0;\n";
/// A definition of one triangle.
const std::string kChip = "def chip; v a 0 0 0; v b 1 0 0; v c 0 1 0; f (a b c); end;\n";

TEST(UnigrafixReader, ReadsFacesNamedAndColouredInAnyOrder) {
  // Names may equal keywords; colours come before or after; vertices may follow their face.
  const Record record = sound("c_rgb f 0.78 0.1 0.2 ;c i 1 2 3 4;f (v w f) f ;\nf end(v f i);" +
                              std::string("v v 0 0 0;v w 1 0 0;v f 1 1 0 ; v i 0 1 0;"));
  EXPECT_EQ(record.text, "UniGrafix");
  EXPECT_THAT(corners_of(record), ElementsAre(Vertex{0, 0, 0}, Vertex{1, 0, 0}, Vertex{1, 1, 0},
                                              Vertex{0, 0, 0}, Vertex{1, 1, 0}, Vertex{0, 1, 0}));
  EXPECT_THAT(names_of(record), ElementsAre(":2"));
}

TEST(UnigrafixReader, NestsCommentsAndTexts) {
  const Record record = sound("{ by {cf,funk}@somewhere {} }" + kSquare +
                              "f{here}(a b{x}c);( a text ( with ; { a comment } ) f ) f(a c d);");
  EXPECT_EQ(record.triangles.size(), 2U);
}

TEST(UnigrafixReader, CutsHolesOut) {
  const Record record = sound(
      "v a 0 0 5;v b 3 0 5;v c 3 3 5;v d 0 3 5;v e 1 1 5;v f 2 1 5;v g 2 2 5;v h 1 2 5;"
      "f (a b c d) (e f g h);f (a b c d) (a b) ;");
  double doubled_area = 0.0;
  const std::vector<Vertex> corners = corners_of(record);
  ASSERT_EQ(corners.size(), 3U * (8U + 2U));
  for (std::size_t i = 0; i < 3 * 8; i += 3) {
    const auto& [a, b, c] = std::array{corners[i], corners[i + 1], corners[i + 2]};
    doubled_area += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  EXPECT_EQ(doubled_area, 2.0 * 8.0);
  EXPECT_THAT(record.notes, Not(HasSubstr("holes")));
}

TEST(UnigrafixReader, FillsHolesThatAreNotInside) {
  const Record record = sound(kSquare + "v e 5 5 0; v f 6 5 0; v g 6 6 0; f (a b c d) (e f g);");
  EXPECT_EQ(record.triangles.size(), 2U);
  EXPECT_THAT(record.notes, HasSubstr("1 holes of faces could not be cut out"));
}

TEST(UnigrafixReader, CountsWiresLightsAndCameras) {
  const Record record = sound(kSquare + "w (a b)(c d) red; l 0.5 1 1 1; cam x -vc 0 0 0; f (a b);");
  EXPECT_EQ(record.header.dropped_points_and_lines, 3U);
  EXPECT_THAT(record.notes, HasSubstr("2 lights and cameras"));
}

struct MapCase {
  std::string transforms;
  Vertex of_1_2_3;
};

TEST(UnigrafixReader, PlacesInstances) {
  // The point is (1, 2, 3); transforms apply in their order.
  const std::vector<MapCase> cases = {
      {"", {1, 2, 3}},
      {"-tx 5", {6, 2, 3}},
      {"-ta 1 -2 .5", {2, 0, 3.5}},
      {"-sx 2", {2, 2, 3}},
      {"-sa 3", {3, 6, 9}},
      {"-sv 0 0 2 10", {1, 2, 30}},
      {"-rz 90", {-2, 1, 3}},
      {"-rx 90", {1, -3, 2}},
      {"-ry -90", {-3, 2, 1}},
      {"-rv 0 0 -7 450", {2, -1, 3}},
      {"-mx", {-1, 2, 3}},
      {"-ma", {-1, -2, -3}},
      {"-mv 0 2 0", {1, -2, 3}},
      {"-tx 1 -rz 90", {-2, 2, 3}},
      {"-rz 90 -tx 1", {-1, 1, 3}},
      {"-M3 0 1 0 -1 0 0 0 0 1", {-2, 1, 3}},
      {"-M4 0 1 0 0 -1 0 0 0 0 0 1 0 10 20 30 1", {8, 21, 33}},
      {"-M4 0 -1 0 10 1 0 0 20 0 0 1 30 0 0 0 1", {8, 21, 33}},
  };
  for (const MapCase& each : cases) {
    SCOPED_TRACE(each.transforms);
    const Record record =
        sound("def d;v p 1 2 3;v q 0 0 0;v r 1 0 0;f (p q r);end;\ni (d " + each.transforms + ");");
    ASSERT_FALSE(record.vertices.empty());
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(record.vertices[0][k], each.of_1_2_3[k], record.header.absolute_rounding) << k;
    }
    EXPECT_LT(record.header.absolute_rounding, 1e-11);
  }
}

TEST(UnigrafixReader, SaysWhichMatricesCouldMeanTwoThings) {
  EXPECT_THAT(sound(kChip + "i (chip -M3 0 1 0 -1 0 0 0 0 1);").notes, HasSubstr("1 matrices"));
  EXPECT_THAT(sound(kChip + "i (chip -M3 2 1 0 1 2 0 0 0 1);").notes, Not(HasSubstr("matrices")));
}

TEST(UnigrafixReader, MirrorsTurnFacesRound) {
  EXPECT_THAT(corners_of(sound(kChip + "i (chip -mx);")),
              ElementsAre(Vertex{0, 1, 0}, Vertex{-1, 0, 0}, Vertex{0, 0, 0}));
}

TEST(UnigrafixReader, RepeatsArraysAndNamesInstances) {
  const Record record = sound(kChip + "def row; a teeth (chip red -tz 1) 3 -tx 10; end;\n" +
                              "i (row); i second (row blue -ty 100); i (chip);");
  EXPECT_THAT(names_of(record),
              ElementsAre("row/teeth:1", "row/teeth:1", "row/teeth:1", "second/teeth:1",
                          "second/teeth:1", "second/teeth:1", "chip:1"));
  EXPECT_THAT(record.vertices[0], ElementsAre(0, 0, 1));
  EXPECT_THAT(record.vertices[3], ElementsAre(10, 0, 1));
  EXPECT_THAT(record.vertices[6], ElementsAre(20, 0, 1));
  EXPECT_THAT(record.vertices[15], ElementsAre(20, 100, 1));
}

TEST(UnigrafixReader, KeepsTheNamesOfDefinitionsApart) {
  const std::string text = kSquare +
                           "def one; v a 9 9 9; v b 8 9 9; v c 8 8 9; f (a b c);\n"
                           "def chip; v a 7 7 7; v b 6 7 7; v c 6 6 7; f (a b c); end; i (chip);\n"
                           "end;\n" +
                           kChip + "f (a b c); i (one); i (chip);";
  EXPECT_THAT(names_of(sound(text)), UnorderedElementsAre(":1", "one:1", "one/chip:1", "chip:1"));
  EXPECT_THAT(corners_of(sound(text))[0], ElementsAre(0, 0, 0));
}

TEST(UnigrafixReader, IncludesFiles) {
  const Files files = {{"chip.ug", kChip}, {"all.ug", "include chip.ug; i (chip);"}};
  EXPECT_THAT(names_of(sound("include \"all.ug\" ; i (chip);", files)),
              ElementsAre("chip:1", "chip:1"));
  EXPECT_EQ(read("\ninclude nowhere.ug;").error, "line 2: 'nowhere.ug' is not there");
  EXPECT_THAT(read("include me.ug;", {{"me.ug", "include me.ug;"}}).error,
              HasSubstr("more than 16 deep"));
  EXPECT_THAT(read("include bad.ug;", {{"bad.ug", "\n\nx;"}}).error, HasSubstr("bad.ug, line 3:"));
}

TEST(UnigrafixReader, NamesTheLineOfAFault) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"v a 0 0;", "line 1: vertex 'a' has ';' in place of a coordinate"},
      {"\nv a 0 0 1e999;", "line 2: vertex 'a' has '1e999' in place of a coordinate"},
      {"v a 0 0 0;\nv a 0 0 0;", "line 2: there is a vertex 'a' already"},
      {"v a 0 0 0 0;", "line 1: ';' should be here, not '0'"},
      {"{ { }\n", "line 1: a comment has no end"},
      {"v a 0 0 0;\n\nf (a\nb a);", "line 4: there is no vertex 'b'"},
      {"f ();", "line 1: a contour has no vertex"},
      {"f a;", "line 1: '(' should be here, not ';'"},
      {"\n\nexecute rm;", "line 3: 'execute' runs a program, which a scene file may not"},
      {"i (x);", "line 1: there is no complete definition 'x' above"},
      {"def d; i (d); end;", "line 1: there is no complete definition 'd' above"},
      {"def d;\nend; def d;", "line 2: there is a definition 'd' already"},
      {"def d;", "line 1: a definition has no end"},
      {"end;", "line 1: 'end' without a definition"},
      {kChip + "i (chip -rv 0 0 0 90);", "line 2: there is no transform '-rv' of 4 numbers"},
      {kChip + "i (chip -tx);", "line 2: there is no transform '-tx' of 0 numbers"},
      {kChip + "a (chip) -1;", "line 2: '-1' is no size of an array"},
      {kChip + "i (chip -M4 1 0 0 1 0 1 0 0 0 0 1 0 1 0 0 1);",
       "line 2: the matrix of '-M4' is projective"},
      {"# 70 \"lost.ug\"\nhello;", "lost.ug, line 70: 'hello' begins no statement of UniGrafix"},
      {"( x", "line 1: a text in parentheses has no end"},
      {"c red 1 2 3", "line 1: a statement has no ';'"},
  };
  for (const auto& [text, fault] : cases) EXPECT_EQ(read(text).error, fault) << text;
}

TEST(UnigrafixReader, RefusesMoreInstancesThanThereIsRoomFor) {
  std::string text = kChip;
  std::string inner = "chip";
  for (int level = 0; level < 10; ++level) {
    const std::string outer = "d" + std::to_string(level);
    text += "def " + outer + "; a (" + inner + ") 1000000 -tx 1; end;\n";
    inner = outer;
  }
  EXPECT_THAT(read(text + "i (" + inner + ");").error, HasSubstr("more than 100000000"));
  // Nothing in it: a thousand million of nothing take no time.
  EXPECT_EQ(read("def d; v a 0 0 0; end; a (d) 1000000000;").error, "");
  std::string deep = "def d0; v a 0 0 0; f (a a a); end;\n";
  for (int level = 0; level < 70; ++level) {
    deep += "def d" + std::to_string(level + 1) + "; i (d" + std::to_string(level) + "); end;\n";
  }
  EXPECT_THAT(read(deep).error, HasSubstr("nested more than 64 deep"));
  EXPECT_EQ(read(kChip + "a (chip) 4;", {}, 16).error, "");
  EXPECT_NE(read(kChip + "a (chip) 4;", {}, 15).error, "");
}

}  // namespace
}  // namespace camway::scene::unigrafix
