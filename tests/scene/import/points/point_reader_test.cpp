// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/point_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "tests/scene/import/points/point_files.h"
#include "tests/support/random.h"

namespace camway::scene::point_readers {
namespace {

using camway::testing::Random;
using point_files::LasKind;
using point_files::PcdEncoding;
using point_files::PcdType;
using point_files::PointList;
using ::testing::HasSubstr;

constexpr std::uint64_t kPointSeed = 20261126;
constexpr std::array kEncodings = {PcdEncoding::kText, PcdEncoding::kBinary,
                                   PcdEncoding::kCompressed};

PointList points_in(std::string_view extension, const std::string& bytes) {
  const auto read = read_points(extension, bytes);
  EXPECT_TRUE(read) << read.error;
  if (!read) return {};
  EXPECT_EQ(read->header.is_cloud, 1U);
  EXPECT_TRUE(read->triangles.empty());
  return read->vertices;
}

std::string fault_of(std::string_view extension, const std::string& bytes) {
  const auto read = read_points(extension, bytes);
  EXPECT_FALSE(read);
  return read.error;
}

TEST(PointReader, KnowsItsExtensions) {
  EXPECT_TRUE(is_point_extension(".pcd") && is_point_extension(".XYZ") &&
              is_point_extension(".Las"));
  EXPECT_FALSE(is_point_extension(".laz") || is_point_extension(".txt") || is_point_extension(""));
}

TEST(PcdReader, ReadsEveryEncodingWithFieldsInAnyOrder) {
  Random random(kPointSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const PointList points = point_files::random_points(random, 1 + random() % 60, 100.0);
    for (const PcdEncoding encoding : kEncodings) {
      for (const PcdType type : {PcdType{'F', 4}, PcdType{'F', 8}}) {
        EXPECT_EQ(points_in(".pcd", point_files::write_pcd(points, encoding, type, &random)),
                  points);
      }
    }
  }
}

TEST(PcdReader, ReadsWholeNumbersOfEverySize) {
  Random random(kPointSeed);
  for (const int bytes : {1, 2, 4, 8}) {
    for (const char sign : {'I', 'U'}) {
      PointList points(20);
      for (auto& point : points) {
        for (double& at : point)
          at = random.integer(sign == 'I' ? -128 : 128, sign == 'I' ? -1 : 255);
      }
      for (const PcdEncoding encoding : kEncodings) {
        EXPECT_EQ(
            points_in(".pcd", point_files::write_pcd(points, encoding, {sign, bytes}, &random)),
            points)
            << sign << bytes;
      }
    }
  }
}

TEST(PcdReader, KeepsDoublesFarAway) {
  const PointList points = {{635619.85, 848899.7, 406.59}, {635619.86, 848899.7, 406.59}};
  EXPECT_EQ(points_in(".pcd", point_files::write_pcd(points, PcdEncoding::kText)), points);
  EXPECT_EQ(points_in(".pcd", point_files::write_pcd(points, PcdEncoding::kCompressed, {'F', 8})),
            points);
}

TEST(PcdReader, TakesPointsWithoutCoordinates) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n";
  const PointList points = points_in(".pcd", head + "nan nan nan\n1 2 3\n-nan -nan NaN\ninf 0 0\n");
  ASSERT_EQ(points.size(), 4U);
  EXPECT_TRUE(std::isnan(points[0][0]) && std::isnan(points[2][2]) && std::isinf(points[3][0]));
  EXPECT_EQ(points[1], (std::array{1.0, 2.0, 3.0}));
}

TEST(PcdReader, NamesTheLineOrTheByteOfAFault) {
  const auto fault = [](const std::string& text) { return fault_of(".pcd", text); };
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  const std::string head = fields + "POINTS 2\nDATA ascii\n";
  EXPECT_THAT(fault(head + "1 2 3\n1 2 q\n"), HasSubstr("line 7: 'q' is no number"));
  EXPECT_THAT(fault(head + "1 2 3\n1 2   \n"),
              HasSubstr("line 7: has 2 values, and a point has 3"));
  EXPECT_THAT(fault(head + "1 2 3 \n           "), HasSubstr("line 7: ends after 1 of 2 points"));
  EXPECT_THAT(fault(head + "1 2 3\n1 2 3\n1 2 3\n"), HasSubstr("line 8: goes on after the 2"));
  EXPECT_THAT(fault(fields + "POINTS 1000000\nDATA ascii\n1 2 3\n"), HasSubstr("says it has"));
  EXPECT_THAT(fault(fields + "POINTS 2\nDATA binary\n1234567"), HasSubstr("from byte 56 on"));
  EXPECT_THAT(fault(fields + "POINTS 1\nDATA binary\n123456789012x"),
              HasSubstr("byte 68: goes on"));
  EXPECT_THAT(fault(fields + "WIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n"),
              HasSubstr("POINTS is 5"));
  EXPECT_THAT(fault(fields + "WIDTH 99999999999\nHEIGHT 99999999999\nDATA ascii\n"),
              HasSubstr("too large"));
  EXPECT_THAT(fault(fields + "POINTS -1\nDATA ascii\n"), HasSubstr("line 4: POINTS"));
  EXPECT_THAT(fault("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n"),
              HasSubstr("has no field z"));
  EXPECT_THAT(fault("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n"),
              HasSubstr("its field z is no single number"));
  EXPECT_THAT(fault("FIELDS x y z\nSIZE 4 4\nDATA ascii\n"), HasSubstr("line 2: SIZE has 2 words"));
  EXPECT_THAT(fault("FIELDS x y z\nCOLOUR red\n"), HasSubstr("line 2: 'COLOUR' is no word"));
  EXPECT_THAT(fault("# nothing\n"), HasSubstr("no line DATA"));
  EXPECT_THAT(fault(fields + "DATA ascii\n"), HasSubstr("holds no point"));
}

TEST(PcdReader, RefusesDamagedCompression) {
  Random random(kPointSeed);
  const PointList points = point_files::random_points(random, 100, 10.0);
  const std::string file = point_files::write_pcd(points, PcdEncoding::kCompressed);
  const std::size_t sizes = file.find("binary_compressed\n") + std::strlen("binary_compressed\n");
  std::string other = file;
  other[sizes + 4] = static_cast<char>(other[sizes + 4] + 1);
  EXPECT_THAT(fault_of(".pcd", other), HasSubstr("are not the 1201 bytes"));
  EXPECT_THAT(fault_of(".pcd", file.substr(0, file.size() - 1)), HasSubstr("says it has"));
  // A reference to bytes before the first one.
  other = file;
  other[sizes + 8] = static_cast<char>(0xE0);
  EXPECT_THAT(fault_of(".pcd", other), HasSubstr("the compressed points are damaged"));
  // Four gigabytes out of a few.
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 300000000\n";
  const std::string few(
      "\x04\0\0\0\0\xa4\x93\xd6"
      "abcd",
      12);
  EXPECT_THAT(fault_of(".pcd", head + "DATA binary_compressed\n" + few),
              HasSubstr("3600000000 bytes cannot be 4 compressed ones"));
}

TEST(XyzReader, ReadsColumnsHoweverTheyAreSeparated) {
  Random random(kPointSeed);
  const PointList points = point_files::random_points(random, 100, 1000.0);
  for (const char* separator : {" ", "\t", ",", " , ", ";", "  \t "}) {
    for (const char* header : {"", "x y z\n", "# a remark\n\n", "//X,Y,Z\n"}) {
      EXPECT_EQ(points_in(".xyz", point_files::write_xyz(points, separator, header)), points);
    }
  }
}

TEST(XyzReader, FindsColumnsByTheirNames) {
  EXPECT_EQ(points_in(".xyz", "id,Z,\"Y\",X\n7,3,2,1,\n8,6,5,4,\n"),
            (PointList{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(points_in(".xyz", "east north up r g b\r\n1 2 3 255 0 x\r\n"), (PointList{{1, 2, 3}}));
  EXPECT_EQ(points_in(".xyz", "1 2 3 # here\r4 5 6 7 8 9"), (PointList{{1, 2, 3}, {4, 5, 6}}));
}

TEST(XyzReader, NamesTheLineOfAFault) {
  EXPECT_THAT(fault_of(".xyz", "1 2 3\n\n# x\n1 2\n"), HasSubstr("line 4: has 2 columns"));
  EXPECT_THAT(fault_of(".xyz", "x y z\na b c\n"), HasSubstr("line 2: 'a' is no number"));
  EXPECT_THAT(fault_of(".xyz", "1,5 2,5 3,5\n"), HasSubstr("commas between digits"));
  EXPECT_THAT(fault_of(".xyz", "x y z\n"), HasSubstr("holds no point"));
  EXPECT_THAT(fault_of(".xyz", "12\n1 2 3\n"), HasSubstr("line 1: has 1 columns"));
}

TEST(LasReader, ReadsEveryVersionAndFormat) {
  Random random(kPointSeed);
  for (int minor = 0; minor <= 4; ++minor) {
    for (int format = 0; format <= 10; ++format) {
      const PointList points = point_files::random_points(random, 30, 500.0, {1e5, -2e5, 0.0});
      const LasKind kind{.minor_version = minor,
                         .format = format,
                         .offset = {1e5, -2e5, 0.5},
                         .extra_bytes = random.integer(0, 9)};
      EXPECT_EQ(points_in(".las", point_files::write_las(points, kind)), points) << minor << format;
    }
  }
}

TEST(LasReader, ScalesAsTheSpecificationSays) {
  const PointList points = {{635619.85, 848899.7, 406.59}};
  const LasKind kind{.scale = {0.01, 0.01, 0.01}};
  const PointList read = points_in(".las", point_files::write_las(points, kind));
  EXPECT_EQ(read[0], (std::array{63561985 * 0.01, 84889970 * 0.01, 40659 * 0.01}));
}

std::string las_without_scale() {
  return point_files::write_las({{1, 2, 3}}, {.scale = {1.0, std::nan(""), 1.0}});
}

TEST(LasReader, NamesWhatIsWrong) {
  const std::string file = point_files::write_las({{1, 2, 3}, {4, 5, 6}});
  const auto with = [&](std::size_t at, char byte) {
    std::string other = file;
    other[at] = byte;
    return fault_of(".las", other);
  };
  EXPECT_THAT(fault_of(".las", "PK"), HasSubstr("does not begin with LASF"));
  EXPECT_THAT(fault_of(".las", file.substr(0, 100)), HasSubstr("ends at byte 100"));
  EXPECT_THAT(fault_of(".las", file.substr(0, file.size() - 1)),
              HasSubstr("from byte 227 on there is room for 1"));
  EXPECT_THAT(with(25, 5), HasSubstr("version 1.5"));
  EXPECT_THAT(with(104, static_cast<char>(0x83)), HasSubstr("laszip"));
  EXPECT_THAT(with(104, 11), HasSubstr("byte 104: points of format 11"));
  EXPECT_THAT(with(105, 33), HasSubstr("byte 105: a point of format 3 has 34 bytes, not 33"));
  EXPECT_THAT(with(96, 1), HasSubstr("byte 96: points begin at byte 1"));
  EXPECT_THAT(fault_of(".las", las_without_scale()), HasSubstr("byte 131: scale"));
  EXPECT_THAT(with(110, 127), HasSubstr("says it has 2130706434 points"));
  EXPECT_THAT(with(107, 0), HasSubstr("holds no point"));
}

}  // namespace
}  // namespace camway::scene::point_readers
