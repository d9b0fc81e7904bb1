// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"
#include "tests/support/notify_socket.h"

namespace camway::integration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A daemon that is run as a service: by a configuration file and under a service manager.
class OperationTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    socket_.emplace(file("notify"));
    setenv("NOTIFY_SOCKET", file("notify").c_str(), 1);
    setenv("WATCHDOG_USEC", "300000", 1);
  }
  void TearDown() override {
    IntegrationTest::TearDown();
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
  }

  void write_config(const std::string& level, const std::vector<std::string>& scenes) const {
    std::ofstream config(file("camwayd.toml"));
    config << "[log]\nlevel = \"" << level << "\"\n";
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
  EXPECT_THAT(daemon().output(), HasSubstr("log.level = \"debug\""));

  write_config("loud", {});
  daemon().signal(SIGHUP);
  EXPECT_NE(socket_->next_of("READY=1"), "");
  EXPECT_THAT(scenes_served(), ElementsAre("gallery", "maze"));
  EXPECT_THAT(daemon().output(), HasSubstr("camwayd.toml:2: log.level: must be one of"));

  daemon().signal(SIGTERM);
  EXPECT_EQ(socket_->next_of("STOPPING=1"), "STOPPING=1");
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
}

TEST_F(OperationTest, IsNotCalledAliveWhileItStandsStill) {
  write_config("info", {"maze"});
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  EXPECT_NE(socket_->next_of("WATCHDOG=1"), "");
  daemon().signal(SIGSTOP);
  // What was sent before it stood.
  while (!socket_->next(std::chrono::milliseconds(500)).empty()) {
  }
  EXPECT_EQ(socket_->next(std::chrono::milliseconds(500)), "");
  daemon().signal(SIGCONT);
  EXPECT_NE(socket_->next_of("WATCHDOG=1"), "");
}

}  // namespace
}  // namespace camway::integration
