// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"
#include "tests/support/slow_mesh.h"

namespace camway::integration {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using ::testing::Not;

/// Returns the number of import processes of a daemon.
int importers_of(pid_t process) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; })) continue;
    const std::string status = read_file(entry.path() / "status");
    const bool is_child = status.find("PPid:\t" + std::to_string(process) + "\n") != status.npos;
    count += is_child && status.starts_with("Name:\tcamway-import\n") ? 1 : 0;
  }
  return count;
}

class SceneImportTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    fs::create_directory(file("root"));
    camway::testing::write_slow_mesh(slow_file());
  }

  std::string slow_file() const { return file("root/slow.obj"); }
  void start() { start_daemon_with_scenes({}, {"--scene-roots", file("root")}); }

  static std::future<SceneAnswer> load_slowly(Client& client, const std::string& scene) {
    SceneMesh mesh;
    mesh.file = "slow.obj";
    return std::async(std::launch::async,
                      [&client, scene, mesh] { return client.load_scene(scene, mesh); });
  }
};

TEST_F(SceneImportTest, OthersMoveMeanwhileAndAStopDoesNotWait) {
  start();
  Client importer(patient());
  std::vector<std::future<SceneAnswer>> loads;
  for (const char* const scene : {"slow1", "slow2"}) loads.push_back(load_slowly(importer, scene));
  ASSERT_TRUE(eventually([&] { return importers_of(daemon().pid()) == 2; })) << daemon().output();

  Client mover(patient());
  ASSERT_TRUE(mover.load_scene("yard", {}).ok());
  ASSERT_TRUE(mover.put_object("yard", "crate", SceneBox{{1, 1, 1}}).ok());
  Pose pose;
  for (int i = 0; i < 20; ++i) {
    pose.position_m[0] = i;
    const SceneAnswer moved = mover.move_object("yard", "crate", pose);
    ASSERT_TRUE(moved.ok()) << moved.error;
    EXPECT_EQ(moved.scene.revision, 3 + i);
  }
  EXPECT_EQ(mover.list_scenes().scenes.size(), 1U);
  EXPECT_EQ(importers_of(daemon().pid()), 2) << "all of that while these were read";

  daemon().signal(SIGTERM);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
  EXPECT_THAT(daemon().output(),
              HasSubstr("reason=\"the daemon is stopping; nothing was changed\""));
  EXPECT_THAT(daemon().output(), Not(HasSubstr("stopped while planning"))) << "the drain limit";

  // The client of a refused request asks the next daemon on its own.
  fs::remove(slow_file());
  fs::copy_file(scene_file("office"), slow_file());
  start();
  for (auto& load : loads) {
    const SceneAnswer answer = load.get();
    EXPECT_TRUE(answer.ok()) << answer.error;
  }
}

TEST_F(SceneImportTest, WhatAKilledDaemonLeftOfUploadsIsRemoved) {
  fs::create_directory(file("tmp"));
  const std::string left = file("tmp/camway_upload_abcdef.obj");
  std::ofstream(left) << "v 0 0 0\n";
  run_daemons_by({"/usr/bin/env", "TMPDIR=" + file("tmp")});
  start();
  EXPECT_FALSE(fs::exists(left));
  EXPECT_THAT(daemon().output(), HasSubstr("removed uploads"));
  Client client(patient());
  EXPECT_TRUE(client.load_scene("world", long_mesh(100'000)).ok());
  EXPECT_TRUE(fs::is_empty(file("tmp")));
}

}  // namespace
}  // namespace camway::integration
