// SPDX-License-Identifier: MIT
#include <zlib.h>

#include "tests/scene/import/inventor/inventor_scene.h"

namespace camway::scene {
namespace {

using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;

std::string gzip(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string result(text.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// Numbers of a binary file, in its order of bytes.
std::string word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255U);
  return bytes;
}

/// A text with its length, filled up to a multiple of four.
std::string binary_name(const std::string& name) {
  std::string bytes = word(static_cast<std::uint32_t>(name.size())) + name;
  while (bytes.size() % 4 != 0) bytes += '\0';
  return bytes;
}

class InventorFiles : public InventorScene {};

TEST_F(InventorFiles, EachLanguageIsNamed) {
  EXPECT_EQ(read(kInventor, "Cube { }").report.format, "Open Inventor");
  EXPECT_EQ(read(kVrml1, "Cube { }", "a.wrl").report.format, "VRML 1.0");
  EXPECT_EQ(read(kVrml97, "Shape { geometry Box { } }", "a.WRL").report.format, "VRML 97");
  EXPECT_EQ(read(kInventor, "Cube { }").report.unit_m, 0.0);
  EXPECT_EQ(read(kInventor, "Units { units INCHES } Cube { }").report.unit_m, 1.0);
  EXPECT_EQ(read(kVrml1, "Cube { }", "a.wrl").report.unit_m, 1.0);
  EXPECT_TRUE(read(kInventor, "Cube { }").report.single_precision);
}

TEST_F(InventorFiles, BinaryIsReadToo) {
  // A cube of width 6: name, flags, number of fields, field, value, flags of the field.
  const std::string cube =
      binary_name("Cube") + word(0) + word(1) + binary_name("width") + word(0x40C00000) + word(0);
  const ImportResult result = read("#Inventor V2.1 binary\n", cube);
  EXPECT_EQ(result.report.format, "Open Inventor, binary");
  EXPECT_EQ(result.report.bounds_m.sizes(), geometry::Vec3(6, 2, 2));
}

TEST_F(InventorFiles, GzipIsDecompressed) {
  const std::string text = std::string(kVrml97) + "Shape { geometry Box { } }";
  for (const std::string name : {"a.wrz", "a.wrl", "a.wrl.gz", "a.iv.gz"}) {
    const ImportResult result = read("", gzip(text), name);
    EXPECT_EQ(result.report.triangles, 12U) << name;
    EXPECT_EQ(result.report.format, "VRML 97, gzip");
  }
  const std::string whole = gzip(text);
  EXPECT_THAT(refusal("", whole.substr(0, whole.size() - 12), "a.wrz"),
              EndsWith("is compressed with gzip, and damaged or cut off"));
  EXPECT_EQ(read("", whole + gzip(" Shape { geometry Sphere { } }"), "a.wrz").report.objects, 2U);
}

TEST_F(InventorFiles, GzipThatHoldsTooMuchIsRefused) {
  // 1100 MB of spaces: a megabyte as a file.
  const std::string piece = gzip(std::string(std::size_t{100} << 20U, ' '));
  std::string bomb = gzip(std::string(kInventor));
  for (int i = 0; i < 11; ++i) bomb += piece;
  EXPECT_THAT(refusal("", bomb, "a.iv"), EndsWith("holds more than 1024 MiB when decompressed"));
}

TEST_F(InventorFiles, WhatCoinCannotReadIsSaidWithItsLine) {
  EXPECT_THAT(refusal(kInventor, "Cube {\n  colour 1\n}\n"),
              EndsWith("cannot be read: Unknown field \"colour\" in \"Cube\", at line 3"));
  EXPECT_THAT(refusal(kInventor, "Separator {\n Cube {"), HasSubstr("at line 3"));
  EXPECT_THAT(refusal(kVrml97, "EXTERNPROTO A [ ] \"b.wrl\"\nA { }", "a.wrl"),
              HasSubstr("prototypes of other files are not read"));
  EXPECT_EQ(read("\xEF\xBB\xBF" + std::string(kInventor), "Cube { }").report.triangles, 12U);
  EXPECT_THAT(refusal("", "Cube { }"), EndsWith("does not begin with '#Inventor V' or '#VRML V'"));
}

TEST_F(InventorFiles, WhatHasNoSurfaceSaysWhatItHas) {
  EXPECT_THAT(
      refusal(kInventor,
              "Coordinate3 { point [ 0 0 0, 1 0 0 ] } LineSet { numVertices 2 } "
              "Text2 { string \"a\" } DirectionalLight { } Switch { Cube { } }"),
      EndsWith("holds no surface: it has 1 LineSet, 1 Text2, 1 child that a switch does not "
               "choose, 1 DirectionalLight"));
  EXPECT_THAT(refusal(kInventor, "Separator { Info { } }"),
              EndsWith("holds no surface: none of its 2 nodes is a shape"));
}

TEST_F(InventorFiles, WhatIsNoGeometryIsIgnoredByName) {
  const ImportResult result =
      read(kVrml97,
           "Shape { geometry Box { } } DEF s TimeSensor { } TouchSensor { } Script { } "
           "Viewpoint { } PointLight { }");
  EXPECT_THAT(result.report.notes, Contains("what is no geometry was not read: 1 PointLight, 1 "
                                            "Script, 1 TimeSensor, 1 TouchSensor, 1 Viewpoint"));
}

TEST_F(InventorFiles, InlineFilesBelowTheFolderAreRead) {
  std::filesystem::create_directories(folder_.path() / "parts");
  folder_.write("parts/box.wrl", std::string(kVrml97) + "Shape { geometry Box { } }");
  folder_.write("parts/two.wrl", std::string(kVrml97) +
                                     "Inline { url \"box.wrl\" } Transform { translation "
                                     "9 0 0 children Inline { url \"box.wrl\" } }");
  folder_.write("parts/cube.iv", std::string(kInventor) + "Cube { }");
  folder_.write("parts/file.iv", std::string(kInventor) + "File { name \"cube.iv\" }");
  folder_.write("parts/zip.wrl", gzip(std::string(kVrml1) + "Cube { }"));
  EXPECT_EQ(read(kVrml97, "Inline { url [ \"http://a.b/c.wrl\", \"parts/two.wrl\" ] }", "a.wrl")
                .report.bounds_m.max(),
            geometry::Vec3(10, 1, 1));
  EXPECT_EQ(read(kInventor, "File { name \"parts/file.iv\" }").report.triangles, 12U);
  const ImportResult inlined =
      read(kVrml1, "Separator { WWWInline { name \"parts/zip.wrl\" } }", "b.wrl");
  EXPECT_EQ(inlined.report.triangles, 12U);
  EXPECT_THAT(inlined.report.notes, Contains("1 inline files were read"));
}

TEST_F(InventorFiles, InlineFilesElsewhereAreRefused) {
  const testing::TemporaryFolder elsewhere;
  const std::string file =
      elsewhere.write("box.wrl", std::string(kVrml97) + "Shape { geometry Box { } }");
  EXPECT_THAT(refusal(kVrml97, "Inline { url \"" + file + "\" }", "a.wrl"),
              EndsWith("is not in the folder of the scene or below it"));
  EXPECT_THAT(refusal(kInventor, "File { name \"" + file + "\" }"),
              EndsWith("is not in the folder of the scene or below it"));
  EXPECT_THAT(refusal(kVrml97, "Inline { url \"missing.wrl\" }", "a.wrl"),
              EndsWith("inline file 'missing.wrl' is not there"));
  EXPECT_THAT(refusal(kInventor, "Cube { } File { name \"missing.iv\" }"), HasSubstr("missing.iv"));
}

TEST_F(InventorFiles, WhatIsNotFetchedIsWarnedOf) {
  const ImportResult result =
      read(kVrml97, "Shape { geometry Box { } } Inline { url \"http://a.b/c.wrl\" }", "a.wrl");
  EXPECT_THAT(result.report.notes,
              Contains("warning: an inline file is not below the scene's folder, "
                       "and was not read: http://a.b/c.wrl"));
}

TEST_F(InventorFiles, LoopsOfInlineFilesAreRefused) {
  folder_.write("b.wrl", std::string(kVrml97) + "Inline { url \"a.wrl\" }");
  EXPECT_THAT(refusal(kVrml97, "Inline { url \"b.wrl\" }", "a.wrl"), HasSubstr("includes itself"));
  folder_.write("c.iv", std::string(kInventor) + "File { name \"d.iv\" }");
  EXPECT_THAT(refusal(kInventor, "File { name \"c.iv\" }", "d.iv"), HasSubstr("includes itself"));
}

TEST_F(InventorFiles, HostileFilesEndTheImportProcessOnly) {
  // A million nodes, each inside the one before.
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += "Separator{";
  const ImportResult nested =
      import_mesh(folder_.write("deep.iv", std::string(kInventor) + deep), {});
  EXPECT_FALSE(nested.mesh);
  // Groups of groups of groups: ten to the twelfth cubes.
  std::string many = "DEF g0 Group { Cube { } }\n";
  for (int i = 1; i <= 12; ++i) {
    many += "DEF g" + std::to_string(i) + " Group {";
    for (int k = 0; k < 10; ++k) many += " USE g" + std::to_string(i - 1);
    many += " }\n";
  }
  ImportOptions options;
  options.time_limit_s = 2.0;
  const ImportResult result =
      import_mesh(folder_.write("many.iv", std::string(kInventor) + many), options);
  EXPECT_FALSE(result.mesh);
}

}  // namespace
}  // namespace camway::scene
