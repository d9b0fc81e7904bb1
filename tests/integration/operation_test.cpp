// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/integration/fixture.h"
#include "tests/support/http_get.h"
#include "tests/support/notify_socket.h"
#include "tests/support/prometheus_checker.h"

namespace camway::integration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Port of the page for Prometheus. Each test has its own network.
constexpr int kMetricsPort = 9464;

/// A daemon that runs as a service: with a configuration file and under a service manager.
class OperationTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    socket_.emplace(file("notify"));
    setenv("NOTIFY_SOCKET", file("notify").c_str(), 1);
    setenv("WATCHDOG_USEC", "900000", 1);
  }
  void TearDown() override {
    IntegrationTest::TearDown();
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
  }

  void write_config(const std::string& level, const std::vector<std::string>& scenes) const {
    std::ofstream config(file("camwayd.toml"));
    config << "[metrics]\nport = " << kMetricsPort << "\n[log]\nlevel = \"" << level << "\"\n";
    for (const std::string& scene : scenes) {
      config << "[[scene]]\nname = \"" << scene << "\"\nfile = \"" << scene_file(scene) << "\"\n";
    }
  }

  static std::vector<std::string> scenes_served() {
    std::vector<std::string> names;
    for (const SceneInfo& scene : Client().status().scenes) names.push_back(scene.name);
    return names;
  }

  std::optional<testing::NotifySocket> socket_;
};

TEST_F(OperationTest, TellsTheServiceManagerAndReloads) {
  write_config("info", {"maze"});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  EXPECT_EQ(socket_->next(), "READY=1\nSTATUS=serving");
  EXPECT_EQ(socket_->next(), "WATCHDOG=1");
  EXPECT_THAT(scenes_served(), ElementsAre("maze"));
  EXPECT_THAT(daemon().output(), HasSubstr("(commit "));

  write_config("debug", {"maze", "gallery"});
  daemon().signal(SIGHUP);
  EXPECT_NE(socket_->next_of("RELOADING=1"), "");
  EXPECT_NE(socket_->next_of("READY=1"), "");
  EXPECT_THAT(scenes_served(), ElementsAre("gallery", "maze"));
  EXPECT_THAT(daemon().output(), HasSubstr("setting=log.level value=debug"));

  write_config("loud", {});
  daemon().signal(SIGHUP);
  EXPECT_NE(socket_->next_of("READY=1"), "");
  EXPECT_THAT(scenes_served(), ElementsAre("gallery", "maze"));
  EXPECT_THAT(daemon().output(), HasSubstr("camwayd.toml:4: log.level: must be one of"));

  daemon().signal(SIGTERM);
  EXPECT_EQ(socket_->next_of("STOPPING=1"), "STOPPING=1");
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
}

TEST_F(OperationTest, WarnsOfAnEnvironmentThatDoesNotCount) {
  const char* const usual = std::getenv("LCM_DEFAULT_URL");
  const std::string before = usual == nullptr ? "" : usual;
  const std::string here = "udpm://239.255.76.67:7700?ttl=0";
  {
    std::ofstream config(file("camwayd.toml"));
    config << "[lcm]\nurl = \"" << here << "\"\n[[scene]]\nname = \"maze\"\nfile = \""
           << scene_file("maze") << "\"\n";
  }
  int runs = 0;
  const auto warned = [&](const std::string& environment) {
    setenv("LCM_DEFAULT_URL", environment.c_str(), 1);
    Process process({CAMWAYD_BINARY, "--config", file("camwayd.toml")},
                    file(std::to_string(++runs) + ".log"));
    EXPECT_NE(socket_->next_of("READY=1"), "") << process.output();
    process.signal(SIGTERM);
    EXPECT_EQ(process.wait(), 0) << process.output();
    EXPECT_NE(socket_->next_of("STOPPING=1"), "");
    return process.output().find("LCM_DEFAULT_URL is set, but does not count") != std::string::npos;
  };
  EXPECT_TRUE(warned("udpm://239.255.76.67:7800?ttl=0"));
  EXPECT_FALSE(warned(here)) << "they agree";
  EXPECT_FALSE(warned("")) << "there is none";
  setenv("LCM_DEFAULT_URL", before.c_str(), 1);
}

TEST_F(OperationTest, LogsObjectsOfJsonWhereThatIsAskedFor) {
  write_config("info", {"office"});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml"), "--log-format", "json"});
  EXPECT_TRUE(Client(patient()).plan(request_of("office-free-door", "office")).ok());
  daemon().signal(SIGTERM);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
  std::vector<std::string> events;
  std::istringstream lines(daemon().output());
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(json.is_object()) << line;
    EXPECT_EQ(json.at("level"), "info") << line;
    events.push_back(json.at("event"));
    if (events.back() == "answered") {
      EXPECT_EQ(json.at("status"), "ok");
    }
  }
  EXPECT_THAT(events, ElementsAre("starting", "reading scene", "scene read", "page of metrics",
                                  "ready", "serving", "answered", "signal", "stopping", "stopped"));
}

TEST_F(OperationTest, IsScrapedUnderLoad) {
  write_config("info", {"office"});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  const auto scrape = [] {
    return testing::PrometheusChecker(
        testing::body_of(testing::http_request(kMetricsPort, "GET", "/metrics")));
  };
  constexpr const char* kPlanned = R"(camway_answers_total{kind="plan",status="ok"})";
  constexpr int kRequests = 40;
  std::atomic<bool> done = false;
  std::jthread load([&] {
    Client client(patient());
    for (int i = 0; i < kRequests; ++i) {
      EXPECT_TRUE(client.plan(request_of("office-free-door", "office")).ok());
    }
    done = true;
  });
  double before = 0.0;
  while (!done) {
    const testing::PrometheusChecker page = scrape();
    ASSERT_EQ(page.faults(), "");
    const double planned = page.value(kPlanned).value_or(-1.0);
    EXPECT_GE(planned, before);
    before = planned;
  }
  EXPECT_TRUE(eventually([&] { return scrape().value(kPlanned) == kRequests; }));
  EXPECT_EQ(scrape().value("camway_planning_seconds_count"), kRequests);

  // Another daemon cannot use the port.
  Process second({CAMWAYD_BINARY, "--config", file("camwayd.toml"), "--prefix", "OTHER"},
                 file("second.log"));
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr("cannot listen on 127.0.0.1 port 9464: Address "
                                         "already in use"));
}

TEST_F(OperationTest, ItsUnitLetsItMakeTheSystemCallsThatItNeeds) {
#ifdef UNIT_FILTER_BINARY
  if (access("/usr/bin/systemd-analyze", X_OK) != 0) GTEST_SKIP() << "there is no systemd";
  write_config("info", {"office"});
  std::ofstream(file("camwayd.toml"), std::ios::app) << "occupancy_resolution_m = 0.2\n";
  run_daemons_by({UNIT_FILTER_BINARY, CAMWAYD_UNIT_FILE});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  Client client(patient());
  EXPECT_TRUE(client.plan(request_of("office-graze-column", "office")).ok());
  const SceneAnswer loaded = client.load_scene("uploaded", long_mesh(200'000));
  EXPECT_TRUE(loaded.ok()) << loaded.error;
  daemon().signal(SIGHUP);
  EXPECT_TRUE(eventually(
      [&] { return daemon().output().find("reloaded configured_scenes=1") != std::string::npos; }));
  EXPECT_NE(testing::http_request(kMetricsPort, "GET", "/metrics"), "");
#else
  GTEST_SKIP() << "a sanitizer makes system calls of its own, which the unit forbids";
#endif
}

TEST_F(OperationTest, IsNotCalledAliveWhileItStandsStill) {
  write_config("info", {"maze"});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  EXPECT_NE(socket_->next_of("WATCHDOG=1"), "");
  daemon().signal(SIGSTOP);
  // Messages from before the daemon was stopped.
  while (!socket_->next(std::chrono::milliseconds(500)).empty()) {
  }
  EXPECT_EQ(socket_->next(std::chrono::milliseconds(500)), "");
  daemon().signal(SIGCONT);
  EXPECT_NE(socket_->next_of("WATCHDOG=1"), "");
}

class CommandTest : public IntegrationTest {
 protected:
  /// Runs `camway` to its end and sets `output` to its outputs.
  int camway(std::vector<std::string> arguments, std::string& output) {
    arguments.insert(arguments.begin(), CAMWAY_BINARY);
    Process process(arguments, file("camway.log"));
    const std::optional<int> code = process.wait();
    output = process.output();
    return code.value_or(-1);
  }
};

TEST_F(CommandTest, StatusSaysHowTheDaemonIs) {
  start_daemon();
  std::string said;
  EXPECT_EQ(camway({"status"}, said), 0) << said;
  EXPECT_THAT(said, HasSubstr("plan, 0 requests wait"));
  EXPECT_THAT(said, HasSubstr("  office: revision 1, "));
  EXPECT_EQ(camway({"status", "--json"}, said), 0) << said;
  const auto json = nlohmann::json::parse(said);
  EXPECT_EQ(json.at("total_scenes"), 3);
  EXPECT_GE(json.at("receipt_to_answer").at("p999_ms"), json.at("receipt_to_answer").at("p50_ms"));
  EXPECT_EQ(json.at("scenes").size(), 3u);
  EXPECT_EQ(camway({"status", "--watch", "--count", "2"}, said), 0) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2) << said;

  stop_daemon();
  EXPECT_EQ(camway({"status", "--timeout-s", "0.1"}, said), 4) << said;
  EXPECT_THAT(said, HasSubstr("no daemon was heard"));
  // All commands have the same exit code for a missing daemon, and another one for a missing scene.
  const std::vector<std::vector<std::string>> commands = {
      {"scene", "list"},
      {"occupancy", "--daemon", "office", "--point", "1,1,1"},
      {"watch", "office", "--request", request_file("office-free-door"), "--for-s", "0.2"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"--timeout-s", "0.5"});
    EXPECT_EQ(camway(command, said), 4) << said;
  }
}

TEST_F(CommandTest, DoctorFindsTheDaemonTheNetworkAndTheScenes) {
  start_daemon();
  {
    std::ofstream config(file("camwayd.toml"));
    config << "[[scene]]\nname = \"maze\"\nfile = \"" << scene_file("maze") << "\"\n";
  }
  std::string said;
  EXPECT_EQ(camway({"doctor", "--json", "--config", file("camwayd.toml")}, said), 0) << said;
  const auto json = nlohmann::json::parse(said);
  EXPECT_EQ(json.at("problems"), 0) << said;
  std::map<std::string, std::string> severities;
  for (const auto& finding : json.at("findings")) {
    severities[finding.at("check")] = finding.at("severity");
  }
  for (const char* check : {"multicast route", "lcm", "daemon", "clocks", "scene files"}) {
    EXPECT_EQ(severities[check], "good") << check;
  }

  Process second({CAMWAYD_BINARY, "--share-prefix", "--scene", "maze=" + scene_file("maze")},
                 file("second.log"));
  EXPECT_TRUE(eventually([&] {
    camway({"doctor"}, said);
    return said.find("more than one is heard") != std::string::npos;
  })) << said;
  second.signal(SIGTERM);
  EXPECT_EQ(second.wait(), 0) << second.output();

  stop_daemon();
  EXPECT_EQ(camway({"doctor", "--timeout-s", "0.1"}, said), 3) << said;
  EXPECT_THAT(said, HasSubstr("mend: systemctl start camwayd"));
  EXPECT_THAT(said, HasSubstr("Camway does not work here yet."));
}

}  // namespace
}  // namespace camway::integration
