// SPDX-License-Identifier: MIT
//
// `camway cache`, and what other commands do with the cache.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/tools/camway/cli_runner.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A wall of 2 * 40 * 40 triangles across Z.
std::string large_wall() {
  constexpr int kSide = 40;
  std::string text;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) text += fmt::format("v {} {} 9\n", i, j);
  }
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int a = 1 + i * (kSide + 1) + j;
      text += fmt::format("f {0} {1} {3}\nf {0} {3} {2}\n", a, a + 1, a + kSide + 1, a + kSide + 2);
    }
  }
  return text;
}

class CliCache : public ::testing::Test {
 protected:
  CliCache() { setenv("CAMWAY_CACHE_DIR", cache().c_str(), 1); }
  ~CliCache() override { setenv("CAMWAY_CACHE_DIR", "", 1); }

  std::string cache() const { return folder_.file("cache"); }
  std::string plan(const std::vector<std::string>& flags = {}) const {
    std::vector<std::string> arguments{"plan", "--request", request_, "--no-timing"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  }
  static nlohmann::json listed() {
    return nlohmann::json::parse(run_camway({"cache", "--json"}).out);
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("wall.obj", large_wall());
  std::string request_ = folder_.write(
      "request.json", request_json({keyframe_json(5, 5, 1), keyframe_json(6, 6, -1)}));
};

TEST_F(CliCache, KeepsTheSceneOfAPlanAndChangesNoAnswer) {
  EXPECT_THAT(listed()["scenes"], IsEmpty());
  const std::string first = plan();
  const nlohmann::json scenes = listed()["scenes"];
  ASSERT_THAT(scenes, SizeIs(1));
  EXPECT_EQ(scenes[0]["file"], scene_);
  EXPECT_EQ(scenes[0]["triangles"], 3200);
  EXPECT_EQ(scenes[0]["same_build"], true);
  EXPECT_EQ(plan(), first);
  EXPECT_EQ(plan({"--no-cache"}), first);
  EXPECT_THAT(run_camway({"cache"}).out, HasSubstr("wall.obj"));
}

TEST_F(CliCache, IsLeftAloneWithNoCache) {
  plan({"--no-cache"});
  EXPECT_FALSE(std::filesystem::exists(cache()));
}

TEST_F(CliCache, IsCleared) {
  plan();
  const CliRun run = run_camway({"cache", "clear"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("1 scene removed"));
  EXPECT_THAT(listed()["scenes"], IsEmpty());
}

TEST_F(CliCache, WarnsOfAFolderThatOthersMayWriteTo) {
  std::filesystem::create_directory(cache());
  std::filesystem::permissions(cache(), std::filesystem::perms::all);
  const CliRun run = run_camway({"plan", "--request", request_});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("warning: " + cache() + ": can be written by others"));
  EXPECT_EQ(run_camway({"cache"}).exit_code, 2);
}

TEST_F(CliCache, ListsReadingsOfAFileApart) {
  plan();
  plan({"--scale", "0.5", "--up", "z-to-y"});
  const CliRun run = run_camway({"cache"});
  EXPECT_THAT(run.out, HasSubstr("wall.obj\n"));
  EXPECT_THAT(run.out, HasSubstr("wall.obj (scale 0.5, z-to-y)\n"));
  const nlohmann::json scenes = listed()["scenes"];
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_NE(scenes[0]["up"], scenes[1]["up"]);
}

TEST_F(CliCache, ASizeThatIsNoNumberIsNamed) {
  setenv("CAMWAY_CACHE_BYTES", "2GiB", 1);
  const CliRun planned = run_camway({"plan", "--request", request_});
  EXPECT_EQ(planned.exit_code, 0);
  EXPECT_THAT(
      planned.err,
      HasSubstr("warning: CAMWAY_CACHE_BYTES is '2GiB'; it must be a whole number of bytes below "
                "2^64, "
                "so the cache of scenes may take 2147483648"));
  const CliRun run = run_camway({"cache"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("CAMWAY_CACHE_BYTES is '2GiB'"));
  EXPECT_EQ(run_camway({"cache", "clear"}).exit_code, 0) << "for which no size counts";
  unsetenv("CAMWAY_CACHE_BYTES");
}

TEST_F(CliCache, WarnsOnceOfAFolderThatCannotBeUsed) {
  const std::string below_a_file = folder_.write("file", "") + "/cache";
  setenv("CAMWAY_CACHE_DIR", below_a_file.c_str(), 1);
  const CliRun run =
      run_camway({"plan", "--request", request_, request_, "--response-dir", folder_.file("out")});
  const std::string warning = "warning: " + below_a_file + ": cannot be opened: Not a directory";
  const std::size_t first = run.err.find(warning);
  ASSERT_NE(first, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find(warning, first + 1), std::string::npos) << run.err;
}

TEST_F(CliCache, WarnsOfAFolderThatCannotBeMade) {
  const std::string dangling = folder_.file("dangling");
  std::filesystem::create_symlink(folder_.file("nowhere/at/all"), dangling);
  // Permissions let root write in /proc, but no folder can be made there.
  for (const std::string& folder : {std::string("/proc/foo/bar"), dangling + "/cache"}) {
    setenv("CAMWAY_CACHE_DIR", folder.c_str(), 1);
    const CliRun run = run_camway({"plan", "--request", request_});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr("warning: " + folder + ": cannot be made: "));
    EXPECT_EQ(run_camway({"cache"}).exit_code, 2);
  }
}

TEST_F(CliCache, MakesNoFolderToListIt) {
  const std::string folder = folder_.file("deep/below/cache");
  setenv("CAMWAY_CACHE_DIR", folder.c_str(), 1);
  EXPECT_EQ(run_camway({"cache"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("deep")));
  plan();
  EXPECT_THAT(listed()["scenes"], SizeIs(1));
}

TEST_F(CliCache, CanBeTurnedOff) {
  setenv("CAMWAY_CACHE_DIR", "", 1);
  plan();
  const CliRun run = run_camway({"cache"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("there is no cache: CAMWAY_CACHE_DIR is empty\n"));
}

}  // namespace
}  // namespace camway::tools
