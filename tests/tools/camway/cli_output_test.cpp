// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;

/// A request, its response, its scene and the camera file that it could be from.
class CliOutput : public ::testing::Test {
 protected:
  CliOutput() {
    folder_.write("wall.obj", wall_obj());
    folder_.write("r.json", request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)}));
    folder_.write("flight.csv",
                  "t,x,y,z,qw,qx,qy,qz\n0,1,0,1,1,0,0,0\n1,1,0,0,1,0,0,0\n2,1,0,-1,1,0,0,0\n");
    run_camway({"plan", "--request", file("r.json"), "--response", file("o.json")});
  }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }

  TemporaryFolder folder_;
};

TEST_F(CliOutput, IsNoFileThatTheCommandReads) {
  const std::string request = file("r.json");
  const std::string response = file("o.json");
  const std::string scene = file("wall.obj");
  const std::string flight = file("flight.csv");
  const std::vector<std::pair<std::string, std::vector<std::string>>> commands = {
      {"r.json", {"plan", "--request", request, "--response", request}},
      {"r.json", {"plan", "--request", request, "--response-dir", file("")}},
      {"wall.obj", {"plan", "--request", request, "--scene", scene, "--response", scene}},
      // The scene that the request names.
      {"wall.obj", {"plan", "--request", request, "--response", scene}},
      {"wall.obj", {"occupancy", "--scene", scene, "--resolution", "0.1", "--write", scene}},
      {"flight.csv",
       {"import", flight, "--fov-x-deg", "60", "--fov-y-deg", "40", "--request", flight}},
      {"wall.obj",
       {"import", flight, "--scene", scene, "--fov-x-deg", "60", "--fov-y-deg", "40", "--request",
        scene}},
      {"o.json", {"export", response, "--request", request, "--format", "csv", "--out", response}},
      {"r.json", {"export", response, "--request", request, "--format", "csv", "--out", request}},
      {"wall.obj", {"export", response, "--request", request, "--format", "csv", "--out", scene}},
      {"r.json", {"load", "--scene", "wall", "--request", request, "--json", request}},
  };
  for (const auto& [name, arguments] : commands) {
    SCOPED_TRACE(arguments.front() + " onto " + name);
    const std::string before = read_all(file(name));
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr(name + ": is read, so it is not written"));
    EXPECT_EQ(read_all(file(name)), before);
  }
}

TEST_F(CliOutput, OfColmapReplacesNoLens) {
  const auto export_to = [&](const std::string& name, const std::string& width = "640") {
    return run_camway({"export", file("o.json"), "--request", file("r.json"), "--format", "colmap",
                       "--width", width, "--out", file(name)});
  };
  const std::string of_user = "1 PINHOLE 100 50 50 25 50 25\n";
  folder_.write("cameras.txt", of_user);
  const CliRun refused = export_to("path.txt");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("cameras.txt: is there already, and is not the lens of"));
  EXPECT_EQ(read_all(file("cameras.txt")), of_user);
  EXPECT_FALSE(std::filesystem::exists(file("path.txt")));
  const CliRun same_name = export_to("cameras.txt");
  EXPECT_EQ(same_name.exit_code, 2);
  EXPECT_THAT(same_name.err, HasSubstr("cameras.txt is where colmap has the lens"));
  EXPECT_EQ(read_all(file("cameras.txt")), of_user);
  std::filesystem::remove(file("cameras.txt"));
  EXPECT_EQ(export_to("cameras.txt").exit_code, 2);
  const CliRun first = export_to("path.txt");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr(", the lens in " + file("cameras.txt")));
  // The same lens again, for the same path or for another one in the folder.
  EXPECT_EQ(export_to("path.txt").exit_code, 0);
  EXPECT_EQ(export_to("other.txt").exit_code, 0);
  EXPECT_EQ(export_to("other.txt", "641").exit_code, 2);
}

}  // namespace
}  // namespace camway::tools
