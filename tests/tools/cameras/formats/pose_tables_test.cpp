// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/cameras/formats/read_format.h"
#include "tools/cameras/files/rotation_matrix.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::Contains;
using testing::error_of;
using testing::expect_near;
using testing::file_of;
using ::testing::HasSubstr;
using testing::look;
using testing::sound;
using testing::top;

TEST(PoseTables, TakeCamerasOfRobotsToLookAlongZ) {
  // Identity: looks along +Z, the top of its picture is -Y.
  const CameraTrack track = sound("tum", "# comment\n5 1 2 3 0 0 0 1\n6 1 2 4 0 0 0 2\n");
  EXPECT_EQ(track.keys[0].time_s, 5.0);
  EXPECT_EQ(track.keys[0].pose_W.position, Vec3(1, 2, 3));
  expect_near(look(track.keys[0]), Vec3::UnitZ());
  expect_near(top(track.keys[0]), -Vec3::UnitY());
  CameraReadOptions gl;
  gl.axes = CameraAxes::kGl;
  expect_near(look(sound("tum", "5 1 2 3 0 0 0 1\n6 1 2 4 0 0 0 2\n", gl).keys[0]), -Vec3::UnitZ());
}

TEST(PoseTables, ReadMatricesOfKitti) {
  // A quarter turn about Y: the camera's +Z, where it looks, is the world's +X.
  const std::string row = "0 0 1 10 0 1 0 20 -1 0 0 30\n";
  CameraReadOptions options;
  options.times = "0.5\n0.75\n";
  const CameraTrack track = sound("kitti", row + row, options);
  EXPECT_EQ(track.keys[1].time_s, 0.75);
  EXPECT_EQ(track.keys[0].pose_W.position, Vec3(10, 20, 30));
  expect_near(look(track.keys[0]), Vec3::UnitX());
  EXPECT_FALSE(sound("kitti", row + row).has_times);
  options.times = "1\n";
  EXPECT_THAT(read_camera(*camera_format("kitti"), file_of("f", row + row), options).error,
              HasSubstr("has 2 poses, but there are 1 times"));
}

/// A row of KITTI with so many digits behind the point.
std::string row_of(const Eigen::Matrix3d& r, int digits) {
  std::string row;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) row += fmt::format("{:.{}f} ", r(i, k), digits);
    row += i < 2 ? "7 " : "7\n";
  }
  return row;
}

TEST(PoseTables, AllowARotationWhatItsDigitsRound) {
  const Eigen::Matrix3d turn =
      Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -2).normalized())).toRotationMatrix();
  for (const int digits : {2, 3, 6, 9}) {
    EXPECT_EQ(sound("kitti", row_of(turn, digits)).keys.size(), 1U) << digits;
  }
  const Eigen::Matrix3d off = turn * Vec3(1.005, 1, 1).asDiagonal();
  EXPECT_EQ(sound("kitti", row_of(off, 2)).keys.size(), 1U);
  EXPECT_THAT(error_of("kitti", row_of(off, 6)), HasSubstr("line 1: its matrix"));
  Eigen::Matrix3d sheared = turn;
  sheared.col(0) = (turn.col(0) + 0.01 * turn.col(1)).normalized();
  EXPECT_THAT(error_of("kitti", row_of(sheared, 6)), HasSubstr("not at right angles"));
}

TEST(PoseTables, RefuseMatricesThatAreNoRotation) {
  const std::string sound_row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_THAT(error_of("kitti", sound_row + "\n0 0 0 0 0 0 0 0 0 0 0 0\n"),
              HasSubstr("line 3: its matrix, without numbers 4, 8 and 12, is no rotation: its "
                        "columns have the lengths 0, 0 and 0"));
  EXPECT_THAT(error_of("kitti", "1 0 0 0 0 1 0 0 0 0 -1 0\n"), HasSubstr("it mirrors"));
  EXPECT_THAT(error_of("kitti", "5 0 0 0 0 5 0 0 0 0 5 0\n"), HasSubstr("lengths 5, 5 and 5"));
  EXPECT_EQ(error_of("kitti", "7 " + sound_row), "f: line 1: has 13 numbers, not 12");
  Eigen::Matrix3d scaled = Vec3(2, 3, 4).asDiagonal();
  EXPECT_EQ(take_scale(scaled), "");
  EXPECT_EQ(scaled, Eigen::Matrix3d::Identity());
  scaled(0, 1) = 0.1;
  EXPECT_THAT(take_scale(scaled), HasSubstr("right angles"));
}

TEST(PoseTables, LeaveOutRowsThatRepeatTheOneBefore) {
  const CameraTrack track =
      sound("tum", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 1 0 0 0 1\n2 0 0 1 0 0 0 1\n");
  EXPECT_EQ(track.keys.size(), 2U);
  EXPECT_THAT(track.notes, Contains("rows that repeat the one before were left out: 2"));
  EXPECT_EQ(error_of("tum", "# a\n1 0 0 0 0 0 0 1\n\n1 1 0 0 0 0 0 1\n"),
            "f: line 4: its time is that of line 2, with another pose: remove one");
  EXPECT_EQ(error_of("tum", "2 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n"),
            "f: line 2: its time is before that of line 1: sort the lines by time");
  EXPECT_THAT(error_of("chan", "1 0 0 0 0 0 0\n1 1 0 0 0 0 0\n"), HasSubstr("line 2: its time"));
}

TEST(PoseTables, RefuseWhatIsNoRow) {
  EXPECT_EQ(error_of("tum", "1 2 3\n"), "f: line 1: has 3 numbers, not 8");
  EXPECT_EQ(error_of("tum", "\n1 2 3 x 5 6 7 8\n"), "f: line 2: 'x' is no number");
  EXPECT_EQ(error_of("tum", ""), "f: is empty");
  EXPECT_EQ(error_of("tum", "# no pose\n"), "f: it has no poses");
  EXPECT_EQ(error_of("tum", "1 0 0 0 0 0 0 0\n"),
            "f: line 1: its quaternion is 0, so it has no direction");
  EXPECT_EQ(error_of("tum", "1 2 3 4 0 0 0 1 9\n"), "f: line 1: has 9 numbers, not 8");
  EXPECT_THAT(error_of("tum", "1403715524907143168 2 3 4 0 0 0 1\n"),
              HasSubstr("line 1: its time, 1403715524907143168, is too large for seconds"));
  EXPECT_EQ(error_of("chan", "1 0 0 0 0 0 0 40 1\n"), "f: line 1: has 9 numbers, not 7 to 8");
}

TEST(PoseTables, RefuseDecimalCommasBetweenBlanks) {
  EXPECT_EQ(error_of("tum", "0,5 1,0 2,0 3,0 0,0 0,0 0,0 1,0\n"),
            "f: line 1: '0,5' is no number: decimals need a point");
  EXPECT_THAT(error_of("tum", "0,5;1;2;3;0;0;0;1\n"), HasSubstr("'0,5' is no number"));
  for (const std::string text :
       {"1,2,3,4,0,0,0,1\n", "1, 2, 3, 4, 0, 0, 0, 1\n", "1;2;3;4;0;0;0;1\n",
        "\xEF\xBB\xBF"
        "1 2 3 4 0 0 0 1\n"}) {
    EXPECT_EQ(sound("tum", text).keys[0].pose_W.position, Vec3(2, 3, 4)) << text;
  }
}

}  // namespace
}  // namespace camway::tools
