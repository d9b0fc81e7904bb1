// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

/// `camway load` against a daemon.
class LoadTest : public IntegrationTest {
 protected:
  /// Runs `camway load` on the scene `office` with a few requests and the arguments `more`, and
  /// does `meanwhile` beside it. Returns its exit code.
  int load(
      const std::vector<std::string>& more, const std::function<void()>& meanwhile = [] {}) {
    std::vector<std::string> arguments{CAMWAY_BINARY, "load",
                                       "--json",      file("load.json"),
                                       "--scene",     "office=" + scene_file("office")};
    for (const char* request : {"office-free-door", "office-graze-door", "office-free-timed"}) {
      arguments.insert(arguments.end(), {"--request", request_file(request)});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process(arguments, file("load.log"));
    meanwhile();
    const std::optional<int> code = process.wait();
    output_ = process.output();
    return code.value_or(-1);
  }

  nlohmann::json measured() const {
    return nlohmann::json::parse(read_file(file("load.json")), nullptr, false);
  }

  std::string output_;
};

TEST_F(LoadTest, EveryAnswerIsWhatPlanningGives) {
  start_daemon({"--workers", "2"});
  ASSERT_EQ(load({"--clients", "4", "--requests", "60", "--seconds", "60"}), 0) << output_;
  const nlohmann::json json = measured();
  EXPECT_EQ(json["requests"], 60);
  EXPECT_EQ(json["answered"], 60);
  EXPECT_EQ(json["by_status"]["ok"], 60);
  EXPECT_GT(json["latency_ms"]["p50"], json["latency_without_planning_ms"]["p50"]);
  EXPECT_LE(json["latency_ms"]["p50"], json["latency_ms"]["p999"]);
  EXPECT_THAT(output_, HasSubstr("0 wrong, 0 lost"));
}

/// Batches of all kinds of queries, of several messages each, from clients at the same time.
TEST_F(LoadTest, EveryOccupancyAnswerIsThatOfTheSameMapHere) {
  start_daemon({"--workers", "2"});
  const auto ask = [&](const std::string& scene) {
    Process process({CAMWAY_BINARY, "load", "--scene", scene, "--occupancy", "3000", "--clients",
                     "3", "--seconds", "1"},
                    file("load.log"));
    const std::optional<int> code = process.wait();
    output_ = process.output();
    return code.value_or(-1);
  };
  EXPECT_EQ(ask("office=" + scene_file("office") + ",occupancy=0.2"), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("0 batches wrong, 0 lost"));
  EXPECT_EQ(ask("office=" + scene_file("office") + ",occupancy=0.25"), 3) << output_;
  EXPECT_THAT(output_, HasSubstr(" batches wrong"));
  EXPECT_EQ(ask("office=" + scene_file("maze") + ",occupancy=0.2"), 2) << output_;
  EXPECT_THAT(output_, HasSubstr("the daemon's scene 'office' (digest "));
  EXPECT_EQ(ask("office=" + scene_file("office")), 2) << output_;
}

TEST_F(LoadTest, AnInvalidRequestIsNamedOnceAndNoSuccess) {
  start_daemon();
  std::ofstream(file("one.json")) << R"({"camera": {"fov_x_deg": 80, "fov_y_deg": 60, "near": 0.1},
      "keyframes": [{"position": [0, 0, 1], "orientation": [1, 0, 0, 0]}]})";
  EXPECT_EQ(load({"--clients", "1", "--requests", "8", "--request", file("one.json")}), 2);
  EXPECT_EQ(measured()["by_status"]["invalid"], 2);
  EXPECT_EQ(measured()["answered"], 8);
  EXPECT_THAT(output_, HasSubstr("by status: 2 invalid, 6 ok"));
  const std::string reason = "one.json: the daemon answers invalid: keyframes: holds 1";
  EXPECT_THAT(output_, HasSubstr(reason));
  EXPECT_EQ(output_.find(reason), output_.rfind(reason));
}

TEST_F(LoadTest, AnotherSceneUnderTheSameNameIsFoundOut) {
  start_daemon_with_scenes({"office=" + scene_file("gallery")});
  EXPECT_EQ(load({"--clients", "1", "--requests", "3"}), 2) << output_;
  EXPECT_THAT(output_, HasSubstr("the daemon's scene 'office' (digest "));
  EXPECT_THAT(output_, HasSubstr(" is not the one of --scene (digest "));
}

TEST_F(LoadTest, EndsWithFourIfTheDaemonIsKilledMeanwhile) {
  start_daemon();
  const auto kill_the_daemon = [&] {
    EXPECT_TRUE(eventually(
        [&] { return daemon().output().find("] answered client=") != std::string::npos; }));
    daemon().signal(SIGKILL);
    EXPECT_EQ(daemon().wait(), 128 + SIGKILL);
  };
  EXPECT_EQ(load({"--clients", "1", "--seconds", "3"}, kill_the_daemon), 4) << output_;
  EXPECT_THAT(output_, HasSubstr("the daemon fell silent meanwhile"));
}

TEST_F(LoadTest, SaysThatThereIsNoDaemon) {
  EXPECT_EQ(load({"--requests", "3"}), 4);
  EXPECT_THAT(output_, HasSubstr("no daemon was heard"));
}

class LoadOnABadNetworkTest : public LoadTest, public ::testing::WithParamInterface<double> {};

TEST_P(LoadOnABadNetworkTest, NothingIsLostOrWrong) {
  start_daemon();
  start_bad_network(GetParam());
  ASSERT_EQ(load({"--url", kFarAwayUrl, "--clients", "16", "--requests", "80", "--seconds", "120"}),
            0)
      << output_;
  const nlohmann::json json = measured();
  EXPECT_EQ(json["answered"], 80);
  EXPECT_GE(json["retries"], static_cast<int>(20 * GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Shares, LoadOnABadNetworkTest, ::testing::ValuesIn(kBadShares),
                         name_of_share);

}  // namespace
}  // namespace camway::integration
