// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/random.h"
#include "tests/tools/camway/cli_runner.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using testing::Random;

constexpr std::uint64_t kRoundTripSeed = 20260718;
constexpr double kRelative = 1e-6;
constexpr std::array<double, 12> kRates = {23.976, 24.0,  25.0, 29.97, 30.0, 48.0,
                                           50.0,   59.94, 60.0, 120.0, 10.0, 200.0};
constexpr std::array<double, 4> kScales = {1.0, 0.01, 0.0254, 100.0};

/// A shot as an artist has it: in the file's units, axes, rate and numbers.
struct Shot {
  CameraTrack track;
  CameraWriteOptions options;
  double scale = 1.0;
  std::string up;
  CameraAxes axes = CameraAxes::kGl;
};

double exact_rate(double rate) {
  return rate == std::round(rate) ? rate : std::round(rate) * 1000.0 / 1001.0;
}

/// A smooth flight with roll, which turns by up to three turns.
CameraTrack random_flight(Random& random, double fps, double scale, std::size_t frames) {
  CameraTrack track;
  track.fps = fps;
  const double turns = random.uniform(-6.0, 6.0) * std::numbers::pi;
  const double roll = random.uniform(-1.0, 1.0);
  const geometry::Vec3 begin = random.in_cube(3.0);
  const geometry::Vec3 way = random.in_cube(3.0);
  const double begin_s = random.chance(0.5) ? 0.0 : random.integer(1, 500) / fps;
  for (std::size_t i = 0; i < frames; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(frames - 1);
    const geometry::Quat turn(Eigen::AngleAxisd(turns * u, geometry::Vec3::UnitY()) *
                              Eigen::AngleAxisd(0.3, geometry::Vec3::UnitX()) *
                              Eigen::AngleAxisd(roll * u, geometry::Vec3::UnitZ()));
    const geometry::Vec3 position =
        (begin + u * way + geometry::Vec3(0.0, std::sin(3.0 * u), 0.0)) / scale;
    track.keys.push_back({begin_s + static_cast<double>(i) / fps, {position, turn}, {}});
  }
  return track;
}

Shot random_shot(Random& random, const CameraFormat& format) {
  const FormatTraits traits = traits_of(format);
  Shot shot;
  const double fps =
      exact_rate(kRates[static_cast<std::size_t>(random.integer(0, kRates.size() - 1))]);
  shot.scale = kScales[static_cast<std::size_t>(random.integer(0, kScales.size() - 1))];
  const std::size_t frames = static_cast<std::size_t>(random.integer(24, 60));
  shot.track = random_flight(random, fps, shot.scale, frames);
  shot.up =
      std::array{"as-in-file", "z-to-y", "y-to-z"}[static_cast<std::size_t>(random.integer(0, 2))];
  shot.axes = traits.has_free_axes && random.chance(0.5)
                  ? (traits.axes == CameraAxes::kGl ? CameraAxes::kCv : CameraAxes::kGl)
                  : traits.axes;
  CameraWriteOptions& options = shot.options;
  options.name = "Hero_" + std::to_string(random.integer(1, 99));
  options.width_px = random.integer(100, 4000);
  options.fov_x_rad = random.uniform(0.4, 1.5);
  options.facts.width_px = options.width_px;
  options.facts.height_px = random.integer(100, 4000);
  options.fov_y_rad = 2.0 * std::atan(std::tan(0.5 * options.fov_x_rad) * options.facts.height_px /
                                      options.width_px);
  options.near_m = random.uniform(0.01, 0.2) / shot.scale;
  options.facts.first_frame = random.integer(-100, 2000);
  for (std::size_t i = 0; i < frames; ++i) {
    options.facts.images.push_back("shot/IMG_" + std::to_string(1000 + 3 * i) + ".jpg");
  }
  return shot;
}

class CliRoundTrip : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("far.obj", "v 1e4 0 0\nv 1e4 1 0\nv 1e4 0 1\nf 1 2 3\n"); }

  /// Writes a file and that beside it, and returns its name.
  std::string write(const CameraFormat& format, const Shot& shot) {
    const auto text = format.write(shot.track, shot.options);
    EXPECT_TRUE(text) << text.error;
    if (format.companion != nullptr) {
      const CompanionFile companion = format.companion(shot.options);
      folder_.write(companion.name, companion.text);
    }
    return folder_.write("shot" + std::string(format.extension), *text);
  }

  static CameraTrack read(const CameraFormat& format, const std::string& name,
                          const CameraReadOptions& options) {
    const auto bytes_of = [](const std::string& file) {
      std::ifstream stream(file, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::string folder = name.substr(0, name.rfind('/') + 1);
    const CameraFile file{name, bytes_of(name),
                          [&](const std::string& other) -> base::Result<std::string> {
                            return bytes_of(folder + other);
                          }};
    const auto track = read_camera(format, file, options);
    EXPECT_TRUE(track) << track.error;
    return track ? *track : CameraTrack{};
  }

  std::string import_and_plan(const std::vector<std::string>& import) {
    const CliRun imported = run_camway(import);
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    const CliRun planned = run_camway(
        {"plan", "--request", folder_.file("r.json"), "--response", folder_.file("o.json")});
    EXPECT_EQ(planned.exit_code, 0) << planned.err;
    return imported.err;
  }

  /// Writes the path to `out/`, and returns the name of the file.
  std::string export_as(const CameraFormat& format, const std::vector<std::string>& more = {}) {
    // The lens that is beside a file of COLMAP is not replaced by another one.
    std::filesystem::remove_all(folder_.file("out"));
    std::filesystem::create_directories(folder_.file("out"));
    const std::string name = folder_.file("out/shot" + std::string(format.extension));
    std::vector<std::string> arguments = {
        "export",   folder_.file("o.json"),   "--request", folder_.file("r.json"),
        "--format", std::string(format.name), "--out",     name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    words_ = run.err;
    return name;
  }

  TemporaryFolder folder_;
  std::string words_;  ///< of the last export
};

void expect_same_poses(const CameraTrack& a, const CameraTrack& b) {
  ASSERT_EQ(a.keys.size(), b.keys.size());
  double size = 0.0;
  for (const TrackKey& key : a.keys) size = std::max(size, key.pose_W.position.norm());
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    const motion::Pose& first = a.keys[i].pose_W;
    const motion::Pose& second = b.keys[i].pose_W;
    EXPECT_LT((first.position - second.position).norm(), kRelative * size) << i;
    EXPECT_LT(first.orientation.angularDistance(second.orientation), kRelative) << i;
    EXPECT_NEAR(a.keys[i].time_s, b.keys[i].time_s, kRelative * (1.0 + a.keys[i].time_s)) << i;
  }
}

TEST_F(CliRoundTrip, GivesBackEachFormatInTheWorldOfItsArtist) {
  Random random(kRoundTripSeed);
  constexpr int kTrials = 3;
  for (const CameraFormat& format : camera_formats()) {
    if (format.write == nullptr) continue;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Shot shot = random_shot(random, format);
      SCOPED_TRACE(std::string(format.name) + " " + std::to_string(trial) + " at " +
                   std::to_string(*shot.track.fps) + ", scale " + std::to_string(shot.scale) +
                   ", " + shot.up);
      const std::string name = write(format, shot);
      std::vector<std::string> import = {"import",
                                         name,
                                         "--format",
                                         std::string(format.name),
                                         "--all",
                                         "--scene",
                                         folder_.file("far.obj"),
                                         "--request",
                                         folder_.file("r.json"),
                                         "--scale",
                                         std::to_string(shot.scale),
                                         "--up",
                                         shot.up,
                                         "--camera-axes",
                                         shot.axes == CameraAxes::kGl ? "gl" : "cv"};
      CameraReadOptions reading;
      reading.axes = shot.axes;
      if (!traits_of(format).has_free_axes) import.resize(import.size() - 2);
      if (format.name == "chan" || !traits_of(format).has_times) {
        reading.fps = shot.track.fps;
        import.insert(import.end(), {"--fps", number_text(*shot.track.fps)});
      }
      if (format.name == "tum" || format.name == "kitti") {
        import.insert(import.end(), {"--fov-x-deg", "60", "--fov-y-deg", "40"});
      }
      import_and_plan(import);
      const CameraTrack before = read(format, name, reading);
      const CameraTrack after = read(format, export_as(format), reading);
      expect_same_poses(before, after);
      EXPECT_EQ(after.facts.first_frame, before.facts.first_frame);
      EXPECT_EQ(after.facts.width_px, before.facts.width_px);
      EXPECT_EQ(after.facts.height_px, before.facts.height_px);
      EXPECT_EQ(after.facts.images, before.facts.images);
      EXPECT_NEAR(after.fps.value_or(0.0), before.fps.value_or(0.0), 1e-9);
      EXPECT_NEAR(widest_fov_y_rad(after).value_or(0.0), widest_fov_y_rad(before).value_or(0.0),
                  kRelative);
      EXPECT_NEAR(after.near_m.value_or(0.0), before.near_m.value_or(0.0),
                  kRelative * before.near_m.value_or(1.0));
      EXPECT_EQ(after.name, before.name);
      if (format.name == "chan" || format.name == "blender") {
        EXPECT_EQ(after.facts.first_frame, shot.options.facts.first_frame);
      }
      if (!traits_of(format).has_times) {
        EXPECT_EQ(after.facts.images.size(), format.name == "kitti" ? 0U : shot.track.keys.size());
      }
    }
  }
}

/// A table of a robot at 20 Hz, in centimetres or as EuRoC has it.
std::string table_text(bool is_euroc) {
  std::string text = is_euroc ? "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], "
                                "q_RS_x [], q_RS_y [], q_RS_z []\n"
                              : "time_ms,x_cm,y_cm,z_cm,qw,qx,qy,qz\n";
  for (int i = 0; i < 20; ++i) {
    const double u = 0.05 * i;
    text += is_euroc ? std::to_string(1403715524907143168 + 50'000'000LL * i)
                     : std::to_string(1000 + 50 * i);
    text += "," + number_text(10.0 * u) + ",1.5,-2," + number_text(std::cos(u)) + ",0," +
            number_text(std::sin(u)) + ",0\n";
  }
  return text;
}

TEST_F(CliRoundTrip, GivesBackTheUnitsOfTablesWithoutALens) {
  const CameraFormat& csv = *camera_format("csv");
  for (const bool is_euroc : {true, false}) {
    SCOPED_TRACE(is_euroc);
    const std::string name = folder_.write("drive.csv", table_text(is_euroc));
    const std::string words = import_and_plan(
        {"import", name, "--all", "--scene", folder_.file("far.obj"), "--request",
         folder_.file("r.json"), "--body", R"({"type": "sphere", "radius_m": 0.2})"});
    EXPECT_THAT(words, HasSubstr("its times are 20 frames a second"));
    CameraReadOptions gl;
    gl.axes = CameraAxes::kGl;
    const std::string written = export_as(csv);
    EXPECT_THAT(words_, HasSubstr("20 frames a second, camera axes gl"));
    std::ifstream stream(written);
    std::string first;
    std::getline(stream, first);
    EXPECT_THAT(first, HasSubstr(is_euroc ? "#timestamp,p_RS_R_x [m]" : "time_ms,x_cm,y_cm,z_cm"));
    expect_same_poses(read(csv, name, gl), read(csv, written, gl));
  }
  for (const CameraFormat& format : camera_formats()) {
    if (format.write == nullptr) continue;
    SCOPED_TRACE(format.name);
    if (!traits_of(format).needs_lens) {
      export_as(format);
      continue;
    }
    const CliRun run =
        run_camway({"export", folder_.file("o.json"), "--request", folder_.file("r.json"),
                    "--format", std::string(format.name), "--out", folder_.file("out/none")});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("camera: is missing, whose field of view"));
  }
}

TEST_F(CliRoundTrip, WritesAnotherWorldThanThatOfTheFileIfAsked) {
  std::string text;
  for (int i = 0; i < 10; ++i)
    text += std::to_string(1001 + i) + " 0 100 -" + std::to_string(i) + " 0 0 0 40\n";
  const std::string name = folder_.write("shot.chan", text);
  import_and_plan({"import", name, "--scene", folder_.file("far.obj"), "--request",
                   folder_.file("r.json"), "--scale", "0.01", "--fps", "25"});
  const CameraFormat& chan = *camera_format("chan");
  CameraReadOptions reading;
  reading.fps = 25.0;
  const CameraTrack same = read(chan, export_as(chan), reading);
  EXPECT_THAT(words_,
              HasSubstr("25 frames a second, from frame 1001, camera axes gl, 0.01 m a unit"));
  EXPECT_EQ(same.facts.first_frame, 1001.0);
  EXPECT_NEAR(same.keys[0].pose_W.position.y(), 100.0, 1e-9);
  const CameraTrack other =
      read(chan,
           export_as(chan, {"--fps", "50", "--first-frame", "7", "--file-scale", "1", "--file-up",
                            "z-to-y", "--camera-axes", "cv"}),
           reading);
  EXPECT_EQ(other.facts.first_frame, 7.0);
  EXPECT_EQ(other.keys.size(), 19U);
  EXPECT_NEAR(other.keys[0].pose_W.position.z(), 1.0, 1e-9);
  // Metres and +Y up are what glTF files have.
  const CameraTrack gltf = read(*camera_format("gltf"), export_as(*camera_format("gltf")), {});
  EXPECT_NEAR(gltf.keys[0].pose_W.position.y(), 1.0, 1e-6);
  EXPECT_EQ(gltf.fps, 25.0);
}

TEST_F(CliRoundTrip, GivesPosesWithoutTimesTheirImagesAgain) {
  Random random(kRoundTripSeed);
  for (const std::string_view name : {"colmap", "transforms", "kitti"}) {
    SCOPED_TRACE(name);
    const CameraFormat& format = *camera_format(name);
    const Shot shot = random_shot(random, format);
    const std::string file = write(format, shot);
    import_and_plan({"import", file, "--format", std::string(name), "--scene",
                     folder_.file("far.obj"), "--request", folder_.file("r.json"), "--fov-x-deg",
                     "60", "--fov-y-deg", "40"});
    const CameraTrack before = read(format, file, {});
    if (name != "kitti") {
      EXPECT_EQ(before.facts.images, shot.options.facts.images);
    }
    const CameraTrack after = read(format, export_as(format), {});
    expect_same_poses(before, after);
    EXPECT_EQ(after.facts.images, before.facts.images);
  }
}

TEST_F(CliRoundTrip, WarnsOfLossesAndMissesScenes) {
  Random random(kRoundTripSeed);
  const CameraFormat& tum = *camera_format("tum");
  const Shot shot = random_shot(random, tum);
  const std::string file = write(tum, shot);
  const auto import = [&](const std::string& scene, const std::string& every) {
    return run_camway({"import", file, "--scene", folder_.file(scene), "--every", every,
                       "--request", "-", "--fov-x-deg", "60", "--fov-y-deg", "40"});
  };
  EXPECT_THAT(import("far.obj", "23").err, HasSubstr("warning: the path through the keyframes"));
  EXPECT_THAT(import("far.obj", "1").err,
              ::testing::Not(HasSubstr("warning: the path through the keyframes")));
  const CliRun missing = import("missing.obj", "1");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("missing.obj does not exist"));
}

}  // namespace
}  // namespace camway::tools
