// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/tools/cameras/formats/read_format.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::Contains;
using testing::error_of;
using testing::file_of;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::look;
using testing::sound;

const std::string kNames = "time,x,y,z,qw,qx,qy,qz\n";

/// The same table with another separator and, if asked, decimal commas.
std::string written(std::string text, char separator, bool has_commas) {
  for (char& c : text) {
    if (c == ',') {
      c = separator;
    } else if (c == '.' && has_commas) {
      c = ',';
    }
  }
  return text;
}

TEST(CsvReader, FindColumnsByTheirNames) {
  const CameraTrack track = sound("csv",
                                  "qw,qx,qy,qz,ignored,pos_z,pos_y,pos_x,time_s,fov_y_deg\n"
                                  "1,0,0,0,9,3,2,1,0.5,40\n1,0,0,0,9,3,2,1,1.5,40\n");
  EXPECT_EQ(track.keys[0].pose_W.position, Vec3(1, 2, 3));
  EXPECT_EQ(track.keys[1].time_s, 1.5);
  EXPECT_LT((look(track.keys[0]) + Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(*track.keys[0].fov_y_rad, 40.0 * kDegree, 1e-12);
  EXPECT_THAT(error_of("csv", "a,b\n1,2\n"),
              HasSubstr("names no column for time, x, y, z, qw, qx, qy, qz"));
}

TEST(CsvReader, ReadNanosecondsOfEuroc) {
  const CameraTrack track =
      sound("csv",
            "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y "
            "[], q_RS_z []\n1403715524907143168,0.5,1.9,0.9,1,0,0,0\n"
            "1403715524912143104,0.6,1.9,0.9,1,0,0,0\n");
  EXPECT_NEAR(track.keys[1].time_s - track.keys[0].time_s, 0.005, 1e-6);
  EXPECT_THAT(track.notes, Contains(HasSubstr("IMU")));
  EXPECT_LT((look(track.keys[0]) - Vec3::UnitZ()).norm(), 1e-12);
}

TEST(CsvReader, ReadsTheSameNumbersInEveryWayOfWritingThem) {
  const std::string text = kNames + "0.5,0.25,-1.5e1,1,0.6,0.8,0,0\n1.5,0.75,-7.125,1.5,1,0,0,0\n";
  const CameraTrack expected = sound("csv", text);
  EXPECT_EQ(expected.keys[0].pose_W.position, Vec3(0.25, -15, 1));
  EXPECT_EQ(expected.keys[1].time_s, 1.5);
  const auto expect_same = [&](const std::string& other) {
    SCOPED_TRACE(other);
    const CameraTrack track = sound("csv", other);
    ASSERT_EQ(track.keys.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(track.keys[i].time_s, expected.keys[i].time_s);
      EXPECT_EQ(track.keys[i].pose_W.position, expected.keys[i].pose_W.position);
      EXPECT_EQ(track.keys[i].pose_W.orientation.coeffs(),
                expected.keys[i].pose_W.orientation.coeffs());
    }
  };
  for (const char separator : {';', '\t'}) {
    expect_same(written(text, separator, false));
    expect_same(written(text, separator, true));
  }
  expect_same("\xEF\xBB\xBF" + text);
  expect_same("\n# a remark\n" + text);
  expect_same(
      "\"time\",\"x\",y,z,qw,qx,qy,qz,\n\"0,5\",\"0,25\",\"-1,5e1\",1,\"0,6\",\"0,8\",0,0,\n"
      "\"1,5\",\"0,75\",\"-7,125\",\"1,5\",1,0,0,0,\n");
}

TEST(CsvReader, RefusesNumbersThatCouldMeanTwoThings) {
  // Decimal commas between commas make twice as many fields.
  EXPECT_EQ(error_of("csv", kNames + "0,0,0,5,1,0,1,0,1,0,0,0,0,0,0,0\n"),
            "f: line 2: has 16 fields, but line 1 names 8 columns: decimal commas need ';' between "
            "fields");
  const std::string names = written(kNames, ';', false);
  EXPECT_EQ(
      error_of("csv", names + "0;0.5;1;1;1;0;0;0\n1;0,5;1;1;1;0;0;0\n"),
      "f: line 3: '0,5' is unclear: numbers have decimal commas in line 3, and points in line "
      "2");
  EXPECT_THAT(error_of("csv", names + "0;1.234,5;1;1;1;0;0;0\n"), HasSubstr("line 2: '1.234,5'"));
  EXPECT_THAT(error_of("csv", names + "0;1,234,5;1;1;1;0;0;0\n"), HasSubstr("is no number"));
}

TEST(CsvReader, CountsLinesAsTheFileHasThem) {
  EXPECT_THAT(error_of("csv", "# remark\n\n" + kNames + "0,0,0,0,1,0,0,0\n\n#\n1,0,x,0,1,0,0,0\n"),
              HasSubstr("f: line 7: 'x' is no number"));
  EXPECT_EQ(error_of("csv", "# remark\n\n" + kNames + "0,0,0,0,1,0,0\n"),
            "f: line 4: has 7 fields, but line 3 names 8 columns");
  EXPECT_EQ(error_of("csv", kNames + "1,0,0,0,1,0,0,0\n\n1,0,0,1,1,0,0,0\n"),
            "f: line 4: its time is that of line 2, with another pose: remove one");
  EXPECT_THAT(error_of("csv", "# remark\ntime,x,z,qx,qy,qz\n"),
              HasSubstr("f: line 2 names no column for y, qw; a table has time, x, y, z"));
  EXPECT_THAT(error_of("csv", "0,0,0,0,1,0,0,0\n"),
              HasSubstr("line 1 has numbers, but should name the columns"));
}

TEST(CsvReader, TakesTheUnitsOfColumns) {
  const auto second_of = [](const std::string& names) {
    return sound("csv", names + "\n0,0,0,0,1,0,0,0\n2000,100,200,300,1,0,0,0\n").keys[1];
  };
  const std::string turn = ",qw,qx,qy,qz";
  EXPECT_EQ(second_of("time_ms,x_cm,y_cm,z_cm" + turn).time_s, 2.0);
  EXPECT_EQ(second_of("time_us,x_cm,y_cm,z_cm" + turn).time_s, 0.002);
  EXPECT_EQ(second_of("Time [s],x_cm,y_cm,z_cm" + turn).time_s, 2000.0);
  EXPECT_EQ(second_of("Time (ms),x_cm,y_cm,z_cm" + turn).time_s, 2.0);
  EXPECT_EQ(second_of("time_ms,x_cm,y_cm,z_cm" + turn).pose_W.position, Vec3(1, 2, 3));
  EXPECT_EQ(second_of("time_ms,Pos X [mm],Pos Y [mm],Pos Z [m]" + turn).pose_W.position,
            Vec3(0.1, 0.2, 300));
  EXPECT_EQ(error_of("csv", "time,x [ft],y,z,qw,qx,qy,qz\n"),
            "f: line 1 column 'x [ft]' has a unit that is not known: m, cm, mm are");
}

TEST(CsvReader, TakesTimesWithoutAUnitByTheirSize) {
  const auto step_of = [](const std::string& first, const std::string& second) {
    const CameraTrack track =
        sound("csv", kNames + first + ",0,0,0,1,0,0,0\n" + second + ",1,0,0,1,0,0,0\n");
    return track.keys[1].time_s - track.keys[0].time_s;
  };
  EXPECT_EQ(step_of("1700000000", "1700000001"), 1.0);
  EXPECT_NEAR(step_of("1700000000000", "1700000001000"), 1.0, 1e-6);
  EXPECT_NEAR(step_of("1700000000000000", "1700000001000000"), 1.0, 1e-6);
  EXPECT_NEAR(step_of("1700000000000000000", "1700000001000000000"), 1.0, 1e-6);
  EXPECT_NEAR(step_of("0", "40000000"), 0.04, 1e-12);
  EXPECT_THAT(error_of("csv", kNames + "0,0,0,0,1,0,0,0\n40000,1,0,0,1,0,0,0\n"),
              HasSubstr("no unit and are 40000 apart: name the column time_s, time_ms"));
}

TEST(CsvReader, TakesBothAnglesOfView) {
  const std::string rows = "\n0,0,0,0,1,0,0,0,80\n1,1,0,0,1,0,0,0,90\n";
  const std::string names = "time,x,y,z,qw,qx,qy,qz,";
  const CameraTrack across = sound("csv", names + "fov_x_deg" + rows);
  EXPECT_NEAR(*widest_fov_x_rad(across), 90.0 * kDegree, 1e-12);
  EXPECT_FALSE(widest_fov_y_rad(across));
  EXPECT_NEAR(*widest_fov_y_rad(sound("csv", names + "fov_y_deg" + rows)), 90 * kDegree, 1e-12);
  EXPECT_THAT(sound("csv", names + "fov" + rows).why_no_fov, HasSubstr("column 'fov' is not read"));
  EXPECT_THAT(error_of("csv", names + "fov_y_deg\n0,0,0,0,1,0,0,0,250\n"),
              HasSubstr("its field of view is 250 degrees"));
  // The table that `write` makes.
  CameraTrack track = sound("csv", kNames + "0,0,0,0,1,0,0,0\n1,1,0,0,1,0,0,0\n");
  const CameraTrack back = sound(
      "csv", *camera_format("csv")->write(track, {"c", 80 * kDegree, 50 * kDegree, 0.1, 100}));
  EXPECT_NEAR(*widest_fov_x_rad(back), 80 * kDegree, 1e-12);
  EXPECT_NEAR(*widest_fov_y_rad(back), 50 * kDegree, 1e-12);
}

}  // namespace
}  // namespace camway::tools
