// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/collada_triangle.h"
#include "tests/tools/camway/cli_runner.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json json_of(const std::string& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

class CliCameras : public ::testing::Test {
 protected:
  /// A flight over a wall: 10 m in a second, up and down again.
  void write_flight(double height_m) {
    folder_.write("wall.obj", "v 5 0 -9\nv 5 1 -9\nv 5 1 9\nv 5 0 9\nf 1 2 3 4\n");
    std::string table = "t,x,y,z,qw,qx,qy,qz\n";
    for (int i = 0; i <= 20; ++i) {
      const double u = i / 20.0;
      table += std::to_string(u) + "," + std::to_string(10.0 * u) + "," +
               std::to_string(4.0 * height_m * u * (1.0 - u)) + ",0,1,0,0,0\n";
    }
    folder_.write("flight.csv", table);
  }

  CliRun import_flight(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"import",      folder_.file("flight.csv"),
                                          "--request",   folder_.file("r.json"),
                                          "--scene",     folder_.file("wall.obj"),
                                          "--fov-x-deg", "60",
                                          "--fov-y-deg", "40"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_camway(arguments);
  }

  /// A response to the request of a level flight, `o.json`, to export.
  void plan_level_flight() {
    write_flight(0.0);
    ASSERT_EQ(import_flight().exit_code, 0);
    ASSERT_EQ(run_camway({"plan", "--request", folder_.file("r.json"), "--response",
                          folder_.file("o.json")})
                  .exit_code,
              0);
  }

  CliRun export_path(const std::string& format, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"export",    folder_.file("o.json"),
                                          "--request", folder_.file("r.json"),
                                          "--format",  format,
                                          "--out",     folder_.file("out." + format)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_camway(arguments);
  }

  void plan() {
    const CliRun run = run_camway(
        {"plan", "--request", folder_.file("r.json"), "--response", folder_.file("o.json")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }

  TemporaryFolder folder_;
};

TEST_F(CliCameras, GoFromFileToFile) {
  write_flight(1.05);
  const CliRun imported = import_flight();
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("21 poses"));
  const json request = json_of(folder_.file("r.json"));
  EXPECT_EQ(request["scene"], "wall.obj");
  EXPECT_NEAR(request["camera"]["fov_x_deg"].get<double>(), 60.0, 1e-9);
  EXPECT_LT(request["keyframes"].size(), 10U);
  plan();
  for (const CameraFormat& format : camera_formats()) {
    if (format.write == nullptr) continue;
    const CliRun run = export_path(std::string(format.name));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("proved free as played between its 21 frames"));
  }
}

TEST_F(CliCameras, SayWhereAndAtWhichRateWhatIsPlayedIsFree) {
  write_flight(1.05);
  ASSERT_EQ(import_flight().exit_code, 0);
  plan();
  // On straight lines between two frames a second the camera flies through the top of the wall,
  // which only the frame in the middle clears.
  const CliRun run = export_path("csv", {"--fps", "3"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("it is too near to the scene from 0."));
  EXPECT_THAT(run.err, ::testing::ContainsRegex("--fps (6|12|24|48) would be free"));
  EXPECT_EQ(export_path("csv", {"--fps", "3", "--no-proof"}).exit_code, 0);
}

TEST_F(CliCameras, WriteFewKeysOnCurvesAndMoreWhereThatIsNotFree) {
  write_flight(1.05);
  ASSERT_EQ(import_flight().exit_code, 0);
  plan();
  const auto keys_of = [&] {
    std::ifstream stream(folder_.file("out.gltf"), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    const auto track = read_camera(*camera_format("gltf"), {"out.glb", bytes, {}}, {});
    EXPECT_TRUE(track && track->playback == Playback::kCubic) << track.error;
    return track ? track->keys.size() : 0;
  };
  const CliRun run = export_path("gltf", {"--keys", "sparse"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("for 21 frames; within "));
  EXPECT_THAT(run.err, HasSubstr("proved free as played between its "));
  EXPECT_LT(keys_of(), 10U);
  // With two keys the flight is a straight line through the wall; keys are added until it is free.
  const std::vector<std::string> far{"--keys", "sparse", "--within-m", "50", "--within-deg", "90"};
  EXPECT_EQ(export_path("gltf", far).exit_code, 0);
  EXPECT_GT(keys_of(), 2U);
  std::vector<std::string> unproved = far;
  unproved.emplace_back("--no-proof");
  EXPECT_EQ(export_path("gltf", unproved).exit_code, 0);
  EXPECT_EQ(keys_of(), 2U);
  EXPECT_THAT(export_path("csv", {"--keys", "sparse"}).err,
              HasSubstr("--keys sparse: csv has no curves between keys"));
}

/// A camera that turns by 450 degrees and rolls, 25 times a second from 0.04 s on.
CameraTrack turning_track() {
  CameraTrack track;
  track.fps = 25.0;
  for (int i = 0; i <= 100; ++i) {
    const double u = i / 100.0;
    const geometry::Quat turn(
        Eigen::AngleAxisd(2.5 * std::numbers::pi * u, geometry::Vec3::UnitY()) *
        Eigen::AngleAxisd(0.4 * u, geometry::Vec3::UnitZ()));
    track.keys.push_back(
        {(i + 1) / 25.0, {geometry::Vec3(4.0 * u, 3.0, std::sin(3.0 * u)), turn}, {}});
  }
  return track;
}

/// The angle about the vertical axis that a track turns by in all, frame by frame.
double turned_rad(const CameraTrack& track) {
  double sum = 0.0;
  for (std::size_t i = 1; i < track.keys.size(); ++i) {
    geometry::Quat step =
        track.keys[i].pose_W.orientation * track.keys[i - 1].pose_W.orientation.conjugate();
    if (step.w() < 0.0) step.coeffs() *= -1.0;
    sum += 2.0 * std::atan2(step.y(), step.w());
  }
  return sum;
}

TEST_F(CliCameras, GiveBackTheSameKindOfFile) {
  write_flight(2.0);
  const CameraTrack track = turning_track();
  for (const std::string format : {"gltf", "chan", "nerfstudio", "tum", "csv"}) {
    SCOPED_TRACE(format);
    const CameraFormat& written = *camera_format(format);
    const CameraWriteOptions options{"Hero", 1.2, 0.7, 0.2, 1920};
    const std::string name =
        folder_.write("Hero" + std::string(written.extension), *written.write(track, options));
    const CliRun imported =
        run_camway({"import", name, "--format", format, "--fps", "25", "--fov-x-deg", "68.7549",
                    "--fov-y-deg", "40.107", "--near-m", "0.2", "--scene", folder_.file("wall.obj"),
                    "--request", folder_.file("r.json")});
    ASSERT_EQ(imported.exit_code, 0) << imported.err;
    plan();
    const CliRun run = export_path(format);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    CameraReadOptions reading;
    reading.fps = 25.0;
    std::ifstream stream(folder_.file("out." + format), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    const auto back = read_camera(written, {"Hero.x", bytes, {}}, reading);
    ASSERT_TRUE(back) << back.error;
    EXPECT_EQ(back->name, "Hero");
    ASSERT_EQ(back->keys.size(), track.keys.size());
    EXPECT_NEAR(turned_rad(*back), turned_rad(track), 0.01);
    if (format == "gltf") {
      EXPECT_EQ(back->fps, 25.0);
      EXPECT_NEAR(*back->fov_y_rad, 0.7, 1e-5);
      EXPECT_NEAR(*back->near_m, 0.2, 1e-9);
      EXPECT_NEAR(back->keys[0].time_s, 0.04, 1e-6);
    }
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      const motion::Pose& pose = back->keys[i].pose_W;
      EXPECT_LT((pose.position - track.keys[i].pose_W.position).norm(), 0.006);
      EXPECT_LT(pose.orientation.angularDistance(track.keys[i].pose_W.orientation), 0.004);
    }
  }
}

/// The fields of view of a request file, in degrees.
std::array<double, 2> fields_of_view(const std::string& file) {
  const json camera = json_of(file)["camera"];
  return {camera["fov_x_deg"].get<double>(), camera["fov_y_deg"].get<double>()};
}

TEST_F(CliCameras, WriteThePictureThatWasProved) {
  write_flight(0.0);
  // The height of 1920 square pixels is no whole number.
  ASSERT_EQ(import_flight({"--near-m", "0.25"}).exit_code, 0);
  const auto import_back = [&](const std::string& format) {
    const CliRun run = run_camway({"import", folder_.file("out." + format), "--format", format,
                                   "--request", folder_.file("back.json")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return fields_of_view(folder_.file("back.json"));
  };
  plan();
  EXPECT_THAT(export_path("gltf").err, ::testing::Not(HasSubstr("note: ")));
  EXPECT_NEAR(import_back("gltf")[0], 60.0, 1e-9);
  const std::vector<std::string> size = {"--width", "1920", "--height", "1080"};
  for (const std::string format : {"blender", "mcap", "transforms"}) {
    const CliRun run = export_path(format, size);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto [fov_x, fov_y] = import_back(format);
    EXPECT_NEAR(fov_x, 60.0, 1e-9) << format;
    EXPECT_NEAR(fov_y, 40.0, 1e-9) << format;
  }
  const CliRun square = export_path("nerfstudio", size);
  EXPECT_THAT(square.err,
              HasSubstr("note: nerfstudio has square pixels, of which 1920 x 1080 show 60 x"));
  EXPECT_LT(import_back("nerfstudio")[1], 40.0);
  EXPECT_THAT(export_path("chan").err, HasSubstr("note: chan has no shape of the picture"));
  EXPECT_THAT(export_path("tum").err, HasSubstr("note: tum has no field of view"));
  const CliRun refused = export_path("gltf", size);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--width: gltf has no size of a picture, but the fields of"));
  const CliRun too_long = export_path("blender", {"--width", "4", "--height", "2000"});
  EXPECT_EQ(too_long.exit_code, 2);
  EXPECT_THAT(too_long.err, HasSubstr("Blender has no pixels more than 200 times as long"));
}

TEST_F(CliCameras, SampleThePath) {
  write_flight(2.0);
  ASSERT_EQ(import_flight().exit_code, 0);
  plan();
  const CliRun table = run_camway({"sample", folder_.file("o.json"), "--fps", "2"});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out,
              ::testing::StartsWith("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n"));
  const json list =
      json::parse(run_camway({"sample", folder_.file("o.json"), "--fps", "2", "--json"}).out);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[1]["time"], 0.5);
  EXPECT_NEAR(list[1]["position"][0].get<double>(), 5.0, 0.01);
  EXPECT_EQ(list[2]["position"], json::parse("[10.0, 0.0, 0.0]"));
}

TEST_F(CliCameras, ChooseKeyframesAsAsked) {
  write_flight(2.0);
  ASSERT_EQ(import_flight({"--all"}).exit_code, 0);
  EXPECT_EQ(json_of(folder_.file("r.json"))["keyframes"].size(), 21U);
  ASSERT_EQ(import_flight({"--every", "10"}).exit_code, 0);
  EXPECT_EQ(json_of(folder_.file("r.json"))["keyframes"].size(), 3U);
  ASSERT_EQ(import_flight({"--within-m", "1"}).exit_code, 0);
  EXPECT_EQ(json_of(folder_.file("r.json"))["keyframes"].size(), 3U);
  EXPECT_EQ(import_flight({"--all", "--every", "2"}).exit_code, 2);
}

TEST_F(CliCameras, TurnAndScaleAsTheScene) {
  write_flight(2.0);
  ASSERT_EQ(import_flight({"--scale", "0.5", "--up", "z-to-y", "--every", "10"}).exit_code, 0);
  const json request = json_of(folder_.file("r.json"));
  EXPECT_EQ(request["scale"], 0.5);
  EXPECT_EQ(request["up"], "z-to-y");
  // (5, 2, 0) of the file.
  EXPECT_EQ(request["keyframes"][1]["position"], json::parse("[2.5, 0.0, -1.0]"));
}

TEST_F(CliCameras, ScaleTheCameraFileAloneWhereTheSceneStatesItsUnit) {
  folder_.write("room.dae", testing::collada_triangle("0 0 0 1000 0 0 0 1000 1000",
                                                      R"(<unit name="centimeter" meter="0.01"/>)"));
  folder_.write("cm.csv", "t,x,y,z,qw,qx,qy,qz\n0,100,200,200,1,0,0,0\n1,300,200,200,1,0,0,0\n");
  const auto import = [&](const std::string& scene, const std::string& flag) {
    return run_camway({"import", folder_.file("cm.csv"), "--request", folder_.file("r.json"),
                       "--fov-x-deg", "60", "--fov-y-deg", "40", "--scene", folder_.file(scene),
                       flag, "0.01"});
  };
  const CliRun both = import("room.dae", "--scale");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.err, HasSubstr("room.dae states its unit, 1 m, so --scale makes it 0.01 m; a "
                                  "unit of "));
  EXPECT_THAT(both.err, HasSubstr("warning: no keyframe lies within the bounds of the scene, which "
                                  "is 0.1 x 0.1 x 0.1 m large"));
  const CliRun alone = import("room.dae", "--camera-scale");
  EXPECT_THAT(alone.err, ::testing::Not(HasSubstr("warning")));
  const json request = json_of(folder_.file("r.json"));
  EXPECT_FALSE(request.contains("scale"));
  EXPECT_EQ(request["_camera"]["scale"], 0.01);
  EXPECT_EQ(request["keyframes"][0]["position"], json::parse("[1.0, 2.0, 2.0]"));
  // Where neither file states a unit, one scale is that of both.
  folder_.write("room.obj", "v 0 0 0\nv 1000 0 0\nv 0 1000 1000\nf 1 2 3\n");
  EXPECT_THAT(import("room.obj", "--scale").err, ::testing::Not(HasSubstr("warning")));
}

TEST_F(CliCameras, RefuseWhatTheyCannotRead) {
  write_flight(2.0);
  folder_.write("flight.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  EXPECT_THAT(import_flight().err, HasSubstr("has one pose; a path needs two"));
  folder_.write("flight.csv", "hello\n");
  const CliRun run = import_flight();
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("line 1 names no column for time, x, y"));
  EXPECT_THAT(run_camway({"import", "nowhere.csv", "--request", "-"}).err,
              HasSubstr("nowhere.csv"));
}

TEST_F(CliCameras, NameWhatIsWrongWithoutObeyingIt) {
  write_flight(2.0);
  // A word that would colour the terminal, and the same in one character of C1.
  folder_.write("e.chan", "1 0 \x1b[31mX\xc2\x9b 0 0 0 0 40\n");
  const CliRun coloured =
      run_camway({"import", folder_.file("e.chan"), "--request", folder_.file("r.json")});
  EXPECT_THAT(coloured.err, HasSubstr("'\\x1b[31mX\\x9b' is no number"));
  EXPECT_THAT(coloured.err, ::testing::Not(HasSubstr("\x1b")));
  folder_.write("r.json", "{\"a\\u001b\": 1}");
  EXPECT_THAT(run_camway({"plan", "--request", folder_.file("r.json")}).err,
              ::testing::AllOf(HasSubstr("a\\x1b"), ::testing::Not(HasSubstr("\x1b"))));
  folder_.write("frames.csv", "frame,x,y,z,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n");
  EXPECT_THAT(
      run_camway({"import", folder_.file("frames.csv"), "--request", folder_.file("r.json")}).err,
      HasSubstr("line 1 names no column for time; a table has time, x, y, z, qw, qx, qy and qz: "
                "frames are not read as times"));
}

TEST_F(CliCameras, TakeNoFolderForAScene) {
  write_flight(2.0);
  const CliRun run =
      run_camway({"import", folder_.file("flight.csv"), "--request", folder_.file("r.json"),
                  "--fov-x-deg", "60", "--fov-y-deg", "40", "--scene", folder_.file("")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is a folder, not a scene file"));
}

TEST_F(CliCameras, WriteNothingThatCannotBeProved) {
  plan_level_flight();
  std::filesystem::remove(folder_.file("wall.obj"));
  EXPECT_EQ(export_path("csv").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out.csv")));
  EXPECT_EQ(export_path("csv", {"--no-proof"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_.file("out.csv")));
}

TEST_F(CliCameras, AskForTheFieldOfView) {
  write_flight(2.0);
  const CliRun run =
      run_camway({"import", folder_.file("flight.csv"), "--request", folder_.file("r.json")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("states no field of view: give --fov-y-deg"));
}

TEST_F(CliCameras, RefuseFlagsThatTheirFormatHasNoUseFor) {
  plan_level_flight();
  const auto message = [&](const std::string& format, const std::vector<std::string>& flags) {
    const CliRun run = export_path(format, flags);
    EXPECT_EQ(run.exit_code, 2) << format;
    return run.err;
  };
  EXPECT_THAT(message("csv", {"--width", "100"}), HasSubstr("--width: csv has no size"));
  EXPECT_THAT(message("tum", {"--height", "100"}), HasSubstr("--height: tum has no size"));
  EXPECT_THAT(message("csv", {"--first-frame", "3"}), HasSubstr("--first-frame: csv does not"));
  EXPECT_THAT(message("gltf", {"--within-m", "1"}),
              HasSubstr("--within-m: counts only with --keys sparse"));
}

// Names in Latin-1, of old disks and of COLMAP's lists.
TEST_F(CliCameras, TakeNamesThatAreNoUtf8) {
  plan_level_flight();
  for (const char* const format :
       {"gltf", "blender", "mcap", "chan", "nerfstudio", "transforms", "colmap"}) {
    const CliRun run = export_path(format, {"--name", "Schlo\xdf"});
    EXPECT_EQ(run.exit_code, 0) << format << ": " << run.err;
  }
  const std::string flight = folder_.write("Schlo\xdf.csv", read_all(folder_.file("flight.csv")));
  const std::vector<std::string> import = {
      "import",      flight, "--request",   folder_.file("s.json"),
      "--fov-x-deg", "60",   "--fov-y-deg", "40"};
  EXPECT_EQ(run_camway(import).exit_code, 0);
  EXPECT_EQ(run_camway({"plan", "--request", folder_.file("s.json"), "--scene",
                        folder_.file("wall.obj"), "--response", folder_.file("Schlo\xdf.json")})
                .exit_code,
            0);
  EXPECT_EQ(
      run_camway({"draw", "--request", folder_.file("s.json"), "--scene", folder_.file("wall.obj"),
                  "--response", folder_.file("Schlo\xdf.json"), "--picture", folder_.file("s.svg")})
          .exit_code,
      0);
  // A request could not name this scene.
  const std::string scene = folder_.write("Schlo\xdf.obj", read_all(folder_.file("wall.obj")));
  std::vector<std::string> with_scene = import;
  with_scene.insert(with_scene.end(), {"--scene", scene});
  const CliRun run = run_camway(with_scene);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is a name that is not UTF-8"));
}

}  // namespace
}  // namespace camway::tools
