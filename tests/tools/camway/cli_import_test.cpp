// SPDX-License-Identifier: MIT
//
// Elements that the importer keeps, rounds and leaves out, as the answers of plan and check show.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/support/collada_triangle.h"
#include "tests/tools/camway/cli_runner.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A coordinate between the adjacent floats 1000000.0 and 1000000.0625.
constexpr double kWall_m = 1000000.03;

/// Returns half of the width of the near quadrilateral of `request_json`.
double half_width_m() { return 0.1 * std::tan(35.0 * std::acos(-1.0) / 180.0); }

class CliImport : public ::testing::Test {
 protected:
  /// Returns the response to a request straight along -Z at `x`, planned in empty space.
  std::string path_at(double x) {
    request_ = folder_.write("request.json",
                             request_json({keyframe_json(x, 0, 1), keyframe_json(x, 0, -1)}));
    folder_.write("wall.obj", "v 0 0 99\nv 1 0 99\nv 0 1 99\nf 1 2 3\n");
    const std::string response = folder_.file("response.json");
    EXPECT_EQ(run_camway({"plan", "--request", request_, "--response", response}).exit_code, 0);
    return response;
  }

  CliRun check(const std::string& scene, const std::string& response) {
    return run_camway(
        {"check", "--json", "--scene", scene, "--request", request_, "--response", response});
  }

  TemporaryFolder folder_;
  std::string request_;
};

/// Returns the wall across y and z.
std::string wall_in(std::string_view extension) {
  const std::string x = fmt::format("{}", kWall_m);
  if (extension == ".obj") {
    return fmt::format("v {0} -9 -9\nv {0} 9 -9\nv {0} 9 9\nv {0} -9 9\nf 1 2 3 4\n", x);
  }
  if (extension == ".off") {
    return fmt::format("OFF\n4 1 0\n{0} -9 -9\n{0} 9 -9\n{0} 9 9\n{0} -9 9\n4 0 1 2 3\n", x);
  }
  if (extension == ".ply") {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "{0} -9 -9\n{0} 9 -9\n{0} 9 9\n{0} -9 9\n4 0 1 2 3\n",
        x);
  }
  return fmt::format(
      "solid\nfacet\nvertex {0} -9 -9\nvertex {0} 9 -9\nvertex {0} 9 9\nendfacet\n"
      "facet\nvertex {0} -9 -9\nvertex {0} 9 9\nvertex {0} -9 9\nendfacet\nendsolid\n",
      x);
}

TEST_F(CliImport, JudgesAPathACentimetreFromAWallFarAway) {
  for (const std::string extension : {".obj", ".off", ".ply", ".stl"}) {
    SCOPED_TRACE(extension);
    const std::string scene = folder_.write("far" + extension, wall_in(extension));
    // Free by a centimetre; it would collide with a wall rounded to a million.
    CliRun run = check(scene, path_at(kWall_m - 0.01 - half_width_m()));
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    const auto json = nlohmann::json::parse(run.out, nullptr, false);
    ASSERT_TRUE(json.is_object()) << run.out;
    EXPECT_EQ(json["certified"], true);
    EXPECT_LE(json["clearance_lower_bound"], 0.01 + 1e-9);
    EXPECT_GE(json["clearance_lower_bound"], 0.8 * 0.01);
    // Colliding by a centimetre; it would miss a wall rounded to a million.
    run = check(scene, path_at(kWall_m - 0.01 + half_width_m()));
    EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
    EXPECT_THAT(run.err, Not(HasSubstr("may be off")));
  }
}

/// Returns a wall at a million, in a format that assimp reads.
std::string collada_wall() {
  return testing::collada_triangle("1000000.03 -9 -9 1000000.03 9 -9 1000000.03 0 9");
}

TEST_F(CliImport, WarnsWhereSinglePrecisionIsCoarserThanTheRequest) {
  const std::string scene = folder_.write("far.dae", collada_wall());
  const CliRun run = check(scene, path_at(kWall_m - 5.0));
  EXPECT_THAT(run.err, HasSubstr("warning: the scene's coordinates may be off by"));
  EXPECT_THAT(run.err, HasSubstr("more than the 0.001 m"));
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << run.out;
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("single precision"));
  EXPECT_THAT(run_camway({"info", "--scene", scene}).err, HasSubstr("may be off by"));
}

TEST_F(CliImport, WarnsOfWhatIsLeftOut) {
  const std::string scene = folder_.write(
      "holes.obj", "v 5 0 0\nv 6 0 0\nv 5 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 9\nf 1 1 2\n");
  const std::string expected =
      "warning: the scene is without faces of its file: 1 with a coordinate that is no usable "
      "number, 1 with a vertex that does not exist, 1 of zero area";
  EXPECT_THAT(check(scene, path_at(0.0)).err, HasSubstr(expected));
  EXPECT_THAT(run_camway({"info", "--scene", scene}).err, HasSubstr(expected));
  const std::string response = folder_.file("planned.json");
  const CliRun run =
      run_camway({"plan", "--scene", scene, "--request", request_, "--response", response});
  EXPECT_THAT(run.err, HasSubstr("holes.obj: the scene is without faces"));
  EXPECT_THAT(read_all(response), HasSubstr("\"warnings\": [\n    \"the scene is"));
}

/// A wall of points, 635 km from the origin, that a path has to go over.
TEST_F(CliImport, LeadsAPathRoundAWallOfPoints) {
  constexpr double kFar_m = 635'000.0;
  std::string points = "x y z\n";
  for (int i = -40; i <= 40; ++i) {
    for (int k = -40; k <= 10; ++k) {
      points += fmt::format("{} {} 0\n", kFar_m + 0.05 * i, 0.05 * k);
    }
  }
  const std::string scene = folder_.write("wall.xyz", points);
  const std::string response = folder_.file("round.json");
  const std::string request = folder_.write(
      "far.json", request_json({keyframe_json(kFar_m, 0, 1), keyframe_json(kFar_m, 0, -1)}));
  CliRun run = run_camway({"plan", "--scene", scene, "--request", request, "--response", response});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("1 collision at first"));
  run = run_camway({"check", "--scene", scene, "--request", request, "--response", response});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  // Voxels of 1 cm are 4 cm apart, so each has all of its faces.
  run = run_camway({"info", "--json", "--voxel-m", "0.01", scene});
  const auto info = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(info.is_object()) << run.out << run.err;
  EXPECT_EQ(info["import"]["triangles"], 12 * 81 * 51);
  run = run_camway(
      {"plan", "--scene", scene, "--request", request, "--response", response, "--voxel-m", "3"});
  EXPECT_EQ(run.exit_code, 2) << "a keyframe is in a voxel";
  EXPECT_THAT(run.err, HasSubstr("keyframe"));
}

TEST_F(CliImport, IsSilentAboutASoundScene) {
  const std::string response = path_at(5.0);
  EXPECT_THAT(read_all(response), Not(HasSubstr("warnings")));
  EXPECT_THAT(check(folder_.file("wall.obj"), response).err, ::testing::IsEmpty());
}

}  // namespace
}  // namespace camway::tools
