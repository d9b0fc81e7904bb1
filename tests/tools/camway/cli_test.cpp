// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The commands, each with its exit codes beside 0, 1 and 2.
const std::vector<std::pair<std::string, std::string>> kCommands{
    {"plan", "34"},  {"check", "3"},  {"info", ""},    {"occupancy", "34"},
    {"load", "34"},  {"draw", ""},    {"replay", "3"}, {"scene", "34"},
    {"status", "4"}, {"watch", "34"}, {"doctor", "3"}};

TEST(Cli, HelpsWithUnitsExitCodesAndAnExample) {
  EXPECT_EQ(run_camway({"--help"}).exit_code, 0);
  EXPECT_THAT(run_camway({"--help"}).out, HasSubstr("Exit codes: 0"));
  for (const auto& [command, codes] : kCommands) {
    const CliRun run = run_camway({command, "--help"});
    EXPECT_EQ(run.exit_code, 0) << command;
    EXPECT_THAT(run.out, HasSubstr("Exit codes: 0 success; 1 our fault"));
    EXPECT_THAT(run.out, HasSubstr("; 2 invalid input"));
    EXPECT_EQ(run.out.find("; 3 ") != std::string::npos, codes.find('3') != std::string::npos)
        << command;
    EXPECT_EQ(run.out.find("; 4 no daemon answered") != std::string::npos,
              codes.find('4') != std::string::npos)
        << command;
    EXPECT_THAT(run.out, HasSubstr("Example: camway " + command));
  }
}

/// Returns the exit code of `camway` followed by `rest`, as the shell sees it.
int exit_code_of_shell(const std::string& rest) {
  return WEXITSTATUS(std::system(("'" CAMWAY_BINARY "' " + rest).c_str()));
}

// A script must not take an empty file for an answer, or a full disk for a crash.
TEST(Cli, OutputThatCannotBeWrittenIsSaid) {
  const TemporaryFolder folder;
  const std::string said = folder.file("said");
  const std::string scene = folder.write("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string& command :
       {std::string("--version"), std::string("plan --help"), "info --scene '" + scene + "'"}) {
    EXPECT_EQ(exit_code_of_shell(command + " >/dev/full 2>'" + said + "'"), 2) << command;
    std::ifstream text(said);
    EXPECT_THAT(std::string(std::istreambuf_iterator<char>(text), {}),
                HasSubstr("standard output cannot be written"));
  }
  EXPECT_EQ(exit_code_of_shell("info --scene '" + scene + "' >'" + said + "'"), 0);
  EXPECT_EQ(exit_code_of_shell("info --scene /nowhere.obj 2>/dev/full"), 2);
  EXPECT_EQ(exit_code_of_shell("info --scene '" + scene + "' <&- >'" + said + "' 2>&-"), 0)
      << "scenes are read whatever the starter has closed";
}

TEST(Cli, HelpOfWhatIsNoCommandSaysSo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"scene", "uplaod", "--help"}, {"uplaod", "--help"}}) {
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("'uplaod' is no command"));
    EXPECT_EQ(run.out, "");
  }
}

TEST(Cli, ShapesOfTheSceneAreToldInTheWordsOfTheFlags) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      {{"--box", "nan,1,1"},
       "camway: --box: must be X,Y,Z, each a number above 0 and at most 1e+09 m, not 'nan' (see"},
      {{"--box", "1,0,1"}, "--box: must be X,Y,Z, each a number above 0"},
      {{"--box", "1,1"}, "camway: --box: takes 3 values (X,Y,Z), not 2 (see camway scene add"},
      {{"--sphere", "-1"}, "--sphere: must be a number above 0 and at most 1e+09 m, not '-1'"},
      {{"--sphere", "1e300"}, "--sphere: must be a number above 0 and at most 1e+09 m"},
      {{"--cylinder", "1,-2"}, "--cylinder: must be RADIUS,HEIGHT, each a number above 0"},
      {{"--cylinder", "1"}, "--cylinder: takes 2 values (RADIUS,HEIGHT), not 1"},
      {{"--sphere", "1", "--chord-error", "0"}, "--chord-error: must be a number above 0"},
      {{"--map", "0"}, "--map: must be a number from 1e-09 to 1e+09, not '0'"},
      {{"--map", "1", "--hit", "0.5"}, "--hit: must be a number above 0.5 and below 1, not '0.5'"},
      {{"--map", "1", "--miss", "1"}, "--miss: must be a number above 0 and below 0.5, not '1'"},
      {{"--box", "1,1,1", "--position", "1,x,1"},
       "--position: must be X,Y,Z, each a number, not 'x'"},
      {{"--box", "1,1,1", "--orientation", "1,0,0"},
       "--orientation: takes 4 values (W,X,Y,Z), not 3"},
  };
  for (const auto& [flags, said] : kCases) {
    std::vector<std::string> arguments{"scene", "add", "hall", "crate"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(said));
  }
}

// The commands without a daemon; other tests cover the others.
TEST(Cli, ANetworkThatLcmCannotUseIsInvalidInput) {
  const TemporaryFolder folder;
  const std::string request = folder.write("r.json", R"({"camera": {"fov_x_deg": 80,
      "fov_y_deg": 60, "near": 0.1}, "keyframes": [
      {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
      {"position": [1, 0, 0], "orientation": [1, 0, 0, 0]}]})");
  const std::vector<std::vector<std::string>> commands{
      {"status"},
      {"scene", "list"},
      {"occupancy", "--daemon", "s", "--point", "1,2,3"},
      {"watch", "s", "--request", request},
  };
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"--url", "bogus://"});
    const CliRun run = run_camway(command);
    EXPECT_EQ(run.exit_code, 2) << command[0] << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr("bogus://"));
  }
}

TEST(Cli, TellsItsVersion) {
  const CliRun run = run_camway({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, StartsWith(std::string("camway ") + CAMWAY_VERSION + " (commit "));
}

class CliScene : public ::testing::Test {
 protected:
  CliScene() { scene_ = folder_.write("wall.obj", wall_obj()); }

  TemporaryFolder folder_;
  std::string scene_;
};

TEST_F(CliScene, InfoReportsWhatWasReadAndAssumed) {
  const CliRun run =
      run_camway({"info", "--scene", scene_, "--scale", "0.5", "--occupancy", "0.1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* expected :
       {"triangles    4 in 2 objects", "size         1.100 x 1.000 x 0.200 m", "0.5 m per unit",
        "axes as-in-file", "octree       threshold 16", "away from the scene",
        "occupied voxels of 0.1 m"}) {
    EXPECT_THAT(run.out, HasSubstr(expected));
  }
}

TEST_F(CliScene, InfoSaysWhyThereIsNoDistanceField) {
  std::string sheets;
  for (int i = 0; i <= 40; ++i) {
    const std::string z = std::to_string(0.1 * i);
    for (const char* corner : {"v 0 0 ", "v 4 0 ", "v 4 4 ", "v 0 4 "}) sheets += corner + z + "\n";
    sheets += "f -4 -3 -2\nf -4 -2 -1\n";
  }
  const std::string file = folder_.write("sheets.obj", sheets);
  EXPECT_THAT(run_camway({"info", "--scene", file}).out,
              HasSubstr("field        off: 0.0 % of the cells"));
  const CliRun run = run_camway({"info", "--scene", file, "--json"});
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << run.out;
  EXPECT_EQ(json["distance_field"]["on"], false);
  EXPECT_THAT(json["distance_field"]["why_off"].get<std::string>(), HasSubstr("does not pay"));
}

TEST_F(CliScene, InfoSpeaksJson) {
  const CliRun run = run_camway({"info", "--scene", scene_, "--json", "--octree-threshold", "1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << run.out;
  EXPECT_EQ(json["import"]["triangles"], 4);
  EXPECT_EQ(json["import"]["bounds_max_m"][1], 1.0);
  EXPECT_EQ(json["octree"]["threshold"], 1);
  EXPECT_EQ(json["distance_field"]["on"], true);
  EXPECT_GT(json["distance_field"]["resolution_m"], 0.0);
  EXPECT_EQ(json["distance_field"]["cells"].size(), 3U);
  EXPECT_GT(json["distance_field"]["memory_bytes"], 0);
  EXPECT_LE(json["distance_field"]["settled_share"], 1.0);
  EXPECT_EQ(json["digest"].get<std::string>().size(), 32U);
  EXPECT_FALSE(json.contains("occupancy"));
}

TEST_F(CliScene, InfoNamesABadFile) {
  for (const std::string& file :
       {folder_.file("missing.obj"), folder_.write("broken.obj", "no scene"), folder_.file("")}) {
    const CliRun run = run_camway({"info", "--scene", file});
    EXPECT_EQ(run.exit_code, 2) << file;
    EXPECT_THAT(run.err, HasSubstr("camway: "));
    EXPECT_THAT(run.err, HasSubstr(file));
  }
}

TEST_F(CliScene, OccupancyAnswersEveryKindOfQuery) {
  const std::string map = folder_.file("map.bt");
  const CliRun run = run_camway(
      {"occupancy", "--scene", scene_, "--resolution", "0.05", "--point=0,0,0", "--point", "1,0,0",
       "--box", "-1,-1,-1,1,1,1", "--box=2,2,2,3,3,3", "--sphere=0.5,0,0,0.4",
       "--sphere=0.5,0,0,0.1", "--ray=0,0,1,0,0,-1,5", "--ray=0,0,1,0,0,1,5", "--distance=0,0,1,2",
       "--distance=0,0,9,2", "--write", map});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* expected :
       {"point 0,0,0: occupied\n", "point 1,0,0: free\n", "box -1,-1,-1,1,1,1: occupied\n",
        "box 2,2,2,3,3,3: free\n", "sphere 0.5,0,0,0.4: occupied\n", "sphere 0.5,0,0,0.1: free\n",
        "ray 0,0,1,0,0,-1,5: 0.9", "ray 0,0,1,0,0,1,5: nothing within range\n",
        "distance 0,0,1,2: 0.9", "distance 0,0,9,2: nothing so near\n"}) {
    EXPECT_THAT(run.out, HasSubstr(expected));
  }
  EXPECT_GT(std::filesystem::file_size(map), 0U);
}

TEST_F(CliScene, OccupancyNamesTheQueryAtFault) {
  const struct {
    const char* query;
    const char* expected;
  } cases[] = {
      {"--point=1,2", "--point 1,2: must be 3 finite numbers"},
      {"--point=1,2,3,4", "--point 1,2,3,4: must be 3"},
      {"--point=1,2,nan", "--point 1,2,nan: must be 3 finite"},
      {"--point=1,2,x", "must be 3 finite"},
      {"--box=1,0,0,0,1,1", "the minimum is above the maximum"},
      {"--sphere=0,0,0,-1", "the radius is negative"},
      {"--ray=0,0,0,0,0,0,1", "the direction is zero"},
      {"--ray=0,0,0,1,0,0,-1", "the range is negative"},
      {"--distance=0,0,0,-1", "the largest distance is negative"},
  };
  for (const auto& c : cases) {
    const CliRun run = run_camway({"occupancy", "--scene", scene_, "--resolution", "0.1", c.query});
    EXPECT_EQ(run.exit_code, 2) << c.query;
    EXPECT_THAT(run.err, HasSubstr(c.expected));
  }
  EXPECT_THAT(run_camway({"occupancy", "--point=0,0,0"}).err, HasSubstr("either --scene FILE or"));
  EXPECT_THAT(run_camway({"occupancy", "--scene", scene_}).err, HasSubstr("needs --resolution"));
  EXPECT_EQ(run_camway({"occupancy", "--scene", scene_, "--daemon", "office"}).exit_code, 2);
}

class CliReplay : public CliScene {
 protected:
  /// Returns a log with the answers of planning in this process; `changed` alters one of them.
  LogBuilder recorded(bool changed) const {
    const auto loaded = scene::load_snapshot("wall", scene_, {});
    EXPECT_TRUE(loaded.snapshot) << loaded.error;
    LogBuilder log;
    for (int i = 0; i < 5; ++i) {
      const double x = 0.1 + 0.05 * i;
      const auto request = simple_request({{x, 0, 1}, {x / 2, 0.3, -1}});
      planning::PlanResult result = planning::plan(*loaded.snapshot, request);
      planning::name_witnesses(loaded.snapshot->mesh, request, result);
      if (changed && i == 3) result.remaining_collisions.push_back({0.0, 0.0});
      log.add_request(request, {"client", i, 0});
      log.add_answer(result, {{"client", i, 0}, "wall", 1, loaded.snapshot->digest});
    }
    return log;
  }
};

TEST_F(CliReplay, EndsWithZeroWhenAllAgreeAndWritesTheSameBytesForAnyThreads) {
  const std::string log = folder_.write("log", recorded(false).bytes());
  const auto run = [&](const std::string& threads) {
    return run_camway({"replay", log, "--scene", "wall=" + scene_, "--threads", threads,
                       "--responses", folder_.file("r" + threads), "--no-timing"});
  };
  const CliRun one = run("1");
  const CliRun four = run("4");
  EXPECT_EQ(one.exit_code, 0) << one.err << one.out;
  EXPECT_EQ(four.exit_code, 0);
  EXPECT_EQ(one.out, four.out);
  EXPECT_THAT(one.out, HasSubstr("verdict: SAME: 5 requests: 5 same, 0 better"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.file("r1"))) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(read_all(folder_.file("r1/" + name)), read_all(folder_.file("r4/" + name)));
    ++files;
  }
  EXPECT_EQ(files, 5U);
}

TEST_F(CliReplay, EndsWithThreeWhenAnAnswerDiffers) {
  const std::string log = folder_.write("log", recorded(true).bytes());
  const CliRun run = run_camway({"replay", log, "--scene", "wall=" + scene_});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("DIFFERENT: first differs in the proof: remaining_collisions"));
  EXPECT_THAT(run.out, HasSubstr("5 requests: 4 same, 0 better, 1 different"));
}

TEST_F(CliReplay, EndsWithTwoAfterTheGoodPartOfATruncatedLog) {
  const std::string bytes = recorded(false).bytes();
  const std::string log = folder_.write("log", bytes.substr(0, bytes.size() - 3));
  const CliRun run = run_camway({"replay", log, "--scene", "wall=" + scene_});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("breaks off"));
  EXPECT_THAT(run.err, HasSubstr("9 good events before it"));
  EXPECT_THAT(run.out, HasSubstr("0 regressed, 1 not compared"));
}

TEST_F(CliReplay, EndsWithTwoForInputThatCannotBeReplayed) {
  const std::string log = folder_.write("log", recorded(false).bytes());
  const std::string text = folder_.write("text", "this is no log, and longer than an event's head");
  const std::string empty = folder_.write("empty", "");
  const struct {
    std::vector<std::string> arguments;
    const char* expected;
  } cases[] = {
      {{"replay", log}, "asks for the scene 'wall': add --scene wall=FILE"},
      {{"replay", log, "--prefix", "OTHER"}, "holds no planning requests on OTHER_PLAN_REQUEST"},
      {{"replay", log, "--prefix", "a.*"}, "--prefix a.*: must be"},
      {{"replay", log, "--scene", "wall=/nonexistent.obj"}, "/nonexistent.obj"},
      {{"replay", log, "--scene", "wall"}, "--scene wall: "},
      {{"replay", log, "--scene", "wall=" + scene_, "--scene", "wall=" + scene_}, "stands twice"},
      {{"replay", text, "--scene", "wall=" + scene_}, "there is no event here"},
      {{"replay", empty, "--scene", "wall=" + scene_}, "holds no planning requests"},
      {{"replay", "/nonexistent/log"}, "/nonexistent/log: does not exist"},
  };
  for (const auto& c : cases) {
    const CliRun run = run_camway(c.arguments);
    EXPECT_EQ(run.exit_code, 2) << c.expected;
    EXPECT_THAT(run.err, HasSubstr(c.expected));
  }
}

}  // namespace
}  // namespace camway::tools
