// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "tests/tools/cameras/formats/read_format.h"
#include "tests/tools/cameras/random_track.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::Contains;
using testing::error_of;
using testing::expect_near;
using testing::file_of;
using testing::Files;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::look;
using testing::Random;
using testing::sound;
using testing::top;

constexpr std::uint64_t kFormatsSeed = 20260603;

TEST(CameraFormats, ReadBackWhatTheyWrite) {
  Random random(kFormatsSeed);
  for (const CameraFormat& format : camera_formats()) {
    SCOPED_TRACE(format.name);
    if (format.write == nullptr) continue;
    for (int trial = 0; trial < 20; ++trial) {
      CameraTrack track = random_track(random, 12, 0.25, 2.5);
      track.fps = 4.0;
      // Straight up and down, where angles are not unique.
      const Quat up(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
      track.keys[3].pose_W.orientation = up;
      track.keys[4].pose_W.orientation = up.conjugate();
      const CameraWriteOptions options{"cam", 80.0 * kDegree, 50.0 * kDegree, 0.25, 1000};
      const auto text = format.write(track, options);
      ASSERT_TRUE(text) << text.error;
      Files others;
      if (format.companion != nullptr) {
        const CompanionFile companion = format.companion(options);
        others[companion.name] = companion.text;
      }
      CameraReadOptions reading;
      reading.fps = 4.0;
      const CameraTrack read = sound(format.name, *text, reading, others);
      ASSERT_EQ(read.keys.size(), track.keys.size());
      const bool is_single = format.name == "gltf" || format.name == "blender";
      for (std::size_t i = 0; i < track.keys.size(); ++i) {
        const motion::Pose& expected = track.keys[i].pose_W;
        const motion::Pose& pose = read.keys[i].pose_W;
        EXPECT_NEAR(read.keys[i].time_s, track.keys[i].time_s, 1e-6);
        EXPECT_LT((pose.position - expected.position).norm(), is_single ? 1e-5 : 1e-12) << i;
        EXPECT_LT(pose.orientation.angularDistance(expected.orientation), 1e-6) << i;
      }
    }
  }
}

TEST(CameraFormats, KnowTheirFilesByNameAndContent) {
  const auto name_of = [](const std::string& name, const std::string& bytes) {
    const CameraFormat* const format = format_of(file_of(name, bytes));
    return format == nullptr ? std::string_view("none") : format->name;
  };
  EXPECT_EQ(name_of("a.glb", ""), "gltf");
  EXPECT_EQ(name_of("a.GLTF", ""), "gltf");
  EXPECT_EQ(name_of("a.chan", ""), "chan");
  EXPECT_EQ(name_of("a.py", ""), "blender");
  EXPECT_EQ(name_of("a.mcap", ""), "mcap");
  EXPECT_EQ(name_of("a.json", R"({"camera_path": []})"), "nerfstudio");
  EXPECT_EQ(name_of("a.json", R"({"frames": [{"transform_matrix": []}]})"), "transforms");
  EXPECT_EQ(name_of("a.json", "{}"), "none");
  EXPECT_EQ(name_of("x/images.txt", ""), "colmap");
  EXPECT_EQ(name_of("a.csv", "t,x,y,z,qx,qy,qz,qw\n"), "csv");
  EXPECT_EQ(name_of("a.txt", "# t x y z\n\n1 2 3 4 5 6 7 8\n"), "tum");
  EXPECT_EQ(name_of("a.txt", "1 2 3 4 5 6 7 8 9 10 11 12\n"), "kitti");
  EXPECT_EQ(name_of("a.txt", "hello\n"), "none");
  // The content counts where names say nothing.
  EXPECT_EQ(name_of("images.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n"), "kitti");
  EXPECT_EQ(name_of("images.txt", "# x\n1 1 0 0 0 0 0 0 1 a.png\n\n"), "colmap");
  EXPECT_EQ(name_of("poses.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n"), "colmap");
  EXPECT_EQ(name_of("a.fbx", "glTF\2"), "gltf");
  EXPECT_EQ(name_of("a.txt",
                    "\xEF\xBB\xBF"
                    "1 2 3 4 5 6 7 8\n"),
            "tum");
}

TEST(CameraFormats, SayWhyAFileIsNone) {
  const auto why = [](const std::string& name, const std::string& bytes) {
    const CameraFile file = file_of(name, bytes);
    const std::string unreadable = why_unreadable(file);
    return unreadable.empty() ? why_no_format(file) : unreadable;
  };
  EXPECT_EQ(why("a.csv", " \n"), "is empty");
  EXPECT_EQ(why("a.csv", "\xFF\xFEt"), "is UTF-16: save it as UTF-8, or as plain CSV");
  EXPECT_THAT(why("a.glb", "Kaydara FBX Binary  "), HasSubstr("rename it to .fbx"));
  EXPECT_THAT(why("a.blend", "x"), HasSubstr("use the add-on"));
  EXPECT_THAT(why("a.bag", "x"), HasSubstr("write the poses as TUM"));
  EXPECT_THAT(why("a.usdz", "x"), HasSubstr("USD is not supported"));
  EXPECT_THAT(why("a.json", "{\n\"a\": }"), HasSubstr("line 2"));
  EXPECT_THAT(why("a.json", "{}"), HasSubstr("has neither 'camera_path'"));
  EXPECT_THAT(why("a.json", R"({"camera": {}, "keyframes": []})"), HasSubstr("camway plan"));
  EXPECT_THAT(why("a.csv", "t,x,y\n"), HasSubstr("line 1 names no column for z, qw"));
  EXPECT_THAT(why("a.txt", "# r\n1 2 3\n"), HasSubstr("Its first line has 3 words"));
  EXPECT_THAT(why("a.dat", std::string("a\0b", 3)), HasSubstr("is binary"));
}

TEST(CameraFormats, TurnChannelsInTheOrderZxy) {
  // Turned by 90 degrees to the left, then up by 30: the order that keeps the picture upright.
  const CameraTrack track = sound("chan", "11 1 2 3 30 90 0 40\n12 1 2 3 0 0 90 40\n");
  EXPECT_NEAR(track.keys[1].time_s, 1.0 / 24.0, 1e-12);
  expect_near(look(track.keys[0]), Vec3(-std::cos(30 * kDegree), 0.5, 0));
  expect_near(top(track.keys[1]), -Vec3::UnitX());
  EXPECT_NEAR(*track.keys[0].fov_y_rad, 40.0 * kDegree, 1e-12);
}

TEST(CameraFormats, WriteChannelsWithoutJumps) {
  CameraTrack track;
  track.fps = 24.0;
  for (int i = 0; i <= 75; ++i) {
    const Quat turn(Eigen::AngleAxisd(10.0 * i * kDegree, Vec3::UnitY()));
    track.keys.push_back({i / 24.0, {Vec3::Zero(), turn}, std::nullopt});
  }
  const std::string text = *camera_format("chan")->write(track, {"c", 1.0, 1.0, 0.1, 100});
  EXPECT_THAT(text, HasSubstr("\n76\t0\t0\t0\t"));
  const CameraTrack back = sound("chan", text);
  EXPECT_THAT(text.substr(text.rfind("\n76\t")), HasSubstr("749.99"));
  expect_near(look(back.keys[75]), look(track.keys[75]));
}

TEST(CameraFormats, ReadPathsOfNerfstudio) {
  const std::string pose =
      R"({"camera_to_world": [0,0,1,5, 0,1,0,6, -1,0,0,7, 0,0,0,1], "fov": 50})";
  const std::string nested =
      R"({"camera_to_world": [[0,0,2,5], [0,2,0,6], [-2,0,0,7], [0,0,0,1]], "fov": 50})";
  const CameraTrack track = sound(
      "nerfstudio", R"({"fps": 10, "render_width": 200, "render_height": 100, "camera_path": [)" +
                        pose + "," + nested + "]}");
  EXPECT_EQ(track.keys[1].time_s, 0.1);
  EXPECT_EQ(*track.aspect, 2.0);
  for (const TrackKey& key : track.keys) {
    EXPECT_EQ(key.pose_W.position, Vec3(5, 6, 7));
    expect_near(look(key), -Vec3::UnitX());
    EXPECT_NEAR(*key.fov_y_rad, 50.0 * kDegree, 1e-12);
  }
  EXPECT_THAT(error_of("nerfstudio", R"({"camera_path": [{"camera_to_world": [1,2]}]})"),
              HasSubstr("camera_path[0].camera_to_world: must be 16 numbers, or 3 or 4 rows of 4"));
  EXPECT_THAT(error_of("nerfstudio", R"({"camera_path": [{"camera_to_world":
              [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})"),
              HasSubstr("is no rotation: it mirrors"));
}

TEST(CameraFormats, ReadAnglesOfTransforms) {
  const std::string frames =
      R"("frames": [{"transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}])";
  EXPECT_NEAR(*widest_fov_x_rad(sound("transforms", R"({"camera_angle_x": 0.7, )" + frames + "}")),
              0.7, 1e-12);
  const CameraTrack track =
      sound("transforms", R"({"fl_x": 50, "w": 100, "h": 50, )" + frames + "}");
  EXPECT_NEAR(*widest_fov_x_rad(track), 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(*widest_fov_y_rad(track), 2.0 * std::atan(0.5), 1e-12);
  EXPECT_FALSE(track.has_times);
}

TEST(CameraFormats, ReadEverySecondLineOfColmap) {
  // World to camera: a half turn about Y, then 5 along Z. The centre is at z = 5, looking along -Z.
  const std::string text =
      "# Image list\n7 0 0 1 0 0 0 5 1 b.png\n\n2 0 0 1 0 1 0 5 1 a.png\n1 2 -1 3 4 -1\n";
  CameraReadOptions options;
  options.fps = 2.0;
  const CameraTrack track =
      sound("colmap", text, options, {{"cameras.txt", "1 PINHOLE 100 50 50 25 50 25\n"}});
  ASSERT_EQ(track.keys.size(), 2U);
  EXPECT_EQ(track.keys[1].time_s, 0.5);
  expect_near(track.keys[0].pose_W.position, Vec3(1, 0, 5));
  expect_near(track.keys[1].pose_W.position, Vec3(0, 0, 5));
  expect_near(look(track.keys[0]), -Vec3::UnitZ());
  EXPECT_NEAR(*widest_fov_x_rad(track), 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(*widest_fov_y_rad(track), 90.0 * kDegree, 1e-12);
}

TEST(CameraFormats, ReadTheLensOfEachFrame) {
  const std::string matrix = R"("transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]])";
  const std::string file = R"({"w": 100, "h": 100, "frames": [{"fl_x": 50, )" + matrix +
                           R"(}, {"fl_x": 25, )" + matrix + "}]}";
  const CameraTrack track = sound("transforms", file);
  EXPECT_NEAR(*track.keys[0].fov_x_rad, 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(*track.keys[1].fov_x_rad, 2.0 * std::atan(2.0), 1e-12);
  EXPECT_NEAR(*track.keys[1].fov_y_rad, 2.0 * std::atan(2.0), 1e-12);
  EXPECT_THAT(
      error_of("transforms", R"({"frames": [{"transform_matrix":
              [[1,0.5,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})"),
      HasSubstr("frames[0].transform_matrix: is no rotation: its columns are not at right"));
  // Each image of COLMAP has its camera.
  const CameraTrack images =
      sound("colmap", "1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 2 b\n\n", {},
            {{"cameras.txt", "1 PINHOLE 100 50 50 25 50 25\n2 SIMPLE_RADIAL 100 50 25 50 25 0\n"}});
  EXPECT_NEAR(*widest_fov_x_rad(images), 2.0 * std::atan(2.0), 1e-12);
}

TEST(CameraFormats, TakeNoAngleOfWhatIsNoFlatPicture) {
  const std::string frames =
      R"("frames": [{"transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})";
  const std::string sizes = R"("fl_x": 50, "w": 100, "h": 50, )";
  for (const std::string kind :
       {R"("camera_model": "OPENCV_FISHEYE", )", R"("is_fisheye": true, )"}) {
    const CameraTrack track = sound("transforms", "{" + kind + sizes + frames);
    EXPECT_FALSE(widest_fov_x_rad(track)) << kind;
    EXPECT_THAT(track.why_no_fov, HasSubstr("which is no flat picture"));
  }
  const CameraTrack path = sound("nerfstudio", R"({"fps": 10, "camera_type": "equirectangular",
      "camera_path": [{"camera_to_world": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "fov": 50}]})");
  EXPECT_FALSE(widest_fov_y_rad(path));
  EXPECT_THAT(path.why_no_fov, HasSubstr("'equirectangular'"));
  const std::string image = "1 1 0 0 0 0 0 0 1 a\n\n";
  EXPECT_THAT(sound("colmap", image, {}, {{"cameras.txt", "1 OPENCV_FISHEYE 9 9 9 9 9 9 0 0\n"}})
                  .why_no_fov,
              HasSubstr("the model OPENCV_FISHEYE"));
  EXPECT_EQ(sound("colmap", image).why_no_fov, "cameras.txt beside it is not there");
  EXPECT_THAT(error_of("chan", "1 0 0 0 0 0 0 200\n"), HasSubstr("200 degrees"));
}

TEST(CameraFormats, GiveAPictureItsHeight) {
  constexpr double kTiny_rad = 1e-9;
  constexpr double kNearlyHalfATurn_rad = 3.1415;
  CameraWriteOptions options{.fov_x_rad = 1.2, .fov_y_rad = 1.2};
  EXPECT_EQ(height_px(options), options.width_px);
  options.fov_y_rad = kTiny_rad;
  EXPECT_EQ(height_px(options), 1);
  options.fov_x_rad = kTiny_rad;
  options.fov_y_rad = kNearlyHalfATurn_rad;
  EXPECT_EQ(height_px(options), 1'000'000) << "more rows than an int counts";
  options.facts.height_px = 720;
  EXPECT_EQ(height_px(options), 720);
}

TEST(CameraFormats, NameWhatIsWrong) {
  EXPECT_THAT(error_of("colmap", "1 1 0 0 0 0 0\n"), HasSubstr("line 1: has 7 words, not 10"));
  EXPECT_THAT(error_of("transforms", "{"), HasSubstr("f: line 1"));
}

}  // namespace
}  // namespace camway::tools
