// SPDX-License-Identifier: MIT
//
// A daemon with a folder for its state, killed and started again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;
using Kind = WatchEvent::Kind;

Pose beside(double x_m) {
  Pose pose;
  pose.position_m = {x_m, 40.0, 0.0};
  return pose;
}

/// The events as numbers, for messages of failed tests.
std::string kinds_of(const std::vector<WatchEvent>& events) {
  std::string text;
  for (const WatchEvent& event : events) {
    text += std::to_string(static_cast<int>(event.kind)) + " (" + event.error + ") ";
  }
  return text;
}

class StateTest : public IntegrationTest {
 protected:
  [[nodiscard]] std::string folder() const { return file("state"); }

  void start() {
    start_daemon_with_scenes({"office=" + scene_file("office")}, {"--state", folder()});
  }
  void kill_daemon() {
    daemon().signal(SIGKILL);
    EXPECT_EQ(daemon().wait(), 128 + SIGKILL);
  }

  /// Returns the output of `camway state` with these arguments.
  std::string state_says(std::vector<std::string> arguments, int expected_code = 0) {
    arguments.insert(arguments.begin(), {CAMWAY_BINARY, "state"});
    Process process(arguments, file("said.log"));
    EXPECT_EQ(process.wait(), expected_code) << process.output();
    return process.output();
  }
};

TEST_F(StateTest, AKilledDaemonHasTheSameScenesAgain) {
  start();
  Client client(patient());
  ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(1.0)).ok());
  ASSERT_TRUE(client.move_object("office", "crate", beside(2.0)).ok());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  ASSERT_TRUE(client.put_object("yard", "ball", SceneSphere{0.5}, beside(0.0)).ok());
  const SceneAnswer office = client.describe_scene("office");
  const SceneAnswer yard = client.describe_scene("yard");
  EXPECT_TRUE(office.daemon_start.durable);
  const SceneAnswer history = client.scene_history("office");
  const PlanResponse path = client.plan(request_of("office-free-door", "office"));
  EXPECT_TRUE(path.ok()) << path.error;

  kill_daemon();
  start();
  const SceneAnswer office_again = client.describe_scene("office");
  const SceneAnswer yard_again = client.describe_scene("yard");
  EXPECT_EQ(office_again.scene.revision, office.scene.revision);
  EXPECT_EQ(office_again.scene.digest, office.scene.digest);
  EXPECT_EQ(yard_again.scene.revision, yard.scene.revision);
  EXPECT_EQ(yard_again.scene.digest, yard.scene.digest);
  EXPECT_NE(office_again.daemon_start.id, office.daemon_start.id);
  EXPECT_EQ(client.scene_history("office").revisions.size(), history.revisions.size());
  EXPECT_EQ(client.plan(request_of("office-free-door", "office")).clearance_lower_bound_m,
            path.clearance_lower_bound_m);
  // The history goes on.
  const SceneAnswer restored = client.restore_scene("office", office.scene.revision - 1);
  EXPECT_TRUE(restored.ok()) << restored.error;
  EXPECT_EQ(restored.scene.revision, office.scene.revision + 1);
}

TEST_F(StateTest, NoAcknowledgedChangeIsLostHoweverOftenItIsKilled) {
  start();
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  std::int64_t acknowledged = 1;
  for (int round = 0; round < 8; ++round) {
    // More changes each time, so that the daemon dies at another moment.
    for (int i = 0; i < 5 + 7 * round; ++i) {
      const SceneAnswer put =
          client.put_object("yard", "crate", SceneBox{{1, 1, 1 + 0.01 * i}}, beside(0.1 * i));
      ASSERT_TRUE(put.ok()) << put.error;
      ASSERT_EQ(put.scene.revision, acknowledged + 1) << "none is lost, none is made twice";
      acknowledged = put.scene.revision;
    }
    kill_daemon();
    start();
  }
  EXPECT_EQ(client.describe_scene("yard").scene.revision, acknowledged);
  EXPECT_THAT(state_says({"check", folder()}), HasSubstr("whole"));
}

TEST_F(StateTest, AWatchedPathIsCheckedAgainstWhatWasKept) {
  start();
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  PlanRequest walk;
  walk.scene = "yard";
  walk.keyframes.resize(2);
  walk.keyframes[0].time_s = 0.0;
  walk.keyframes[1].time_s = 4.0;
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  Pose in_the_way;
  in_the_way.position_m = {2.0, 0.0, 0.0};
  ASSERT_TRUE(client.put_object("yard", "crate", SceneBox{{0.5, 0.5, 0.5}}, in_the_way).ok());
  std::mutex mutex;
  std::vector<WatchEvent> events;
  client.watch(walk, [&](const WatchEvent& event) {
    const std::lock_guard lock(mutex);
    events.push_back(event);
  });
  const auto count = [&](Kind kind) {
    const std::lock_guard lock(mutex);
    return std::ranges::count(events, kind, &WatchEvent::kind);
  };
  ASSERT_TRUE(eventually([&] { return count(Kind::kAnswer) == 1; }));
  kill_daemon();
  start();
  ASSERT_TRUE(eventually([&] { return count(Kind::kRestarted) == 1; }));
  ASSERT_TRUE(eventually([&] { return count(Kind::kAnswer) == 2; }));
  const std::lock_guard lock(mutex);
  std::vector<PlanResponse> answers;
  for (const WatchEvent& event : events) {
    if (event.kind == Kind::kAnswer) answers.push_back(*event.answer);
  }
  EXPECT_EQ(answers[1].scene_revision, answers[0].scene_revision);
  EXPECT_EQ(answers[1].scene_digest, answers[0].scene_digest);
  EXPECT_EQ(answers[1].path.segments().size(), answers[0].path.segments().size());
}

TEST_F(StateTest, ADaemonThatForgotIsToldToTheWatcher) {
  start_daemon_with_scenes({"office=" + scene_file("office")});
  std::mutex mutex;
  std::vector<WatchEvent> events;
  Client client(patient());  // after what its handler uses, so that it ends before
  EXPECT_FALSE(client.status().daemon_start.durable);
  ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(1.0)).ok());
  client.watch(request_of("office-free-door", "office"), [&](const WatchEvent& event) {
    const std::lock_guard lock(mutex);
    events.push_back(event);
  });
  const auto heard = [&](Kind kind) {
    const std::lock_guard lock(mutex);
    return std::ranges::count(events, kind, &WatchEvent::kind) > 0;
  };
  ASSERT_TRUE(eventually([&] { return heard(Kind::kAnswer); }));
  kill_daemon();
  start_daemon_with_scenes({"office=" + scene_file("office")});
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return events.back().kind == Kind::kLost && events.back().status == Status::kOldScene;
  })) << kinds_of(events);
  {
    const std::lock_guard lock(mutex);
    EXPECT_THAT(events.back().error, HasSubstr("has forgotten changes"));
    EXPECT_EQ(std::ranges::count(events, Kind::kAnswer, &WatchEvent::kind), 1) << "no older ok";
  }
  // Once the change is made again, the path is watched again.
  ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(1.0)).ok());
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return std::ranges::count(events, Kind::kAnswer, &WatchEvent::kind) == 2;
  }));
}

TEST_F(StateTest, AChangedFileReplacesItsOwnObjectOnly) {
  namespace fs = std::filesystem;
  fs::copy_file(scene_file("office"), file("room.obj"));
  const std::vector<std::string> scenes{"room=" + file("room.obj")};
  start_daemon_with_scenes(scenes, {"--state", folder()});
  Client client(patient());
  ASSERT_TRUE(client.put_object("room", "crate", SceneBox{{1, 1, 1}}, beside(1.0)).ok());
  const SceneAnswer before = client.describe_scene("room");
  kill_daemon();
  fs::copy_file(scene_file("maze"), file("room.obj"), fs::copy_options::overwrite_existing);
  start_daemon_with_scenes(scenes, {"--state", folder()});
  const SceneAnswer after = client.describe_scene("room");
  EXPECT_GT(after.scene.revision, before.scene.revision);
  EXPECT_NE(after.scene.digest, before.scene.digest);
  EXPECT_EQ(after.objects.size(), 2U) << "the crate is still there";
  kill_daemon();
  fs::remove(file("room.obj"));
  start_daemon_with_scenes(scenes, {"--state", folder()});
  EXPECT_EQ(client.describe_scene("room").scene.digest, after.scene.digest) << "gone, but kept";
}

TEST_F(StateTest, AnExportIsABackup) {
  start();
  Client client(patient());
  ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(1.0)).ok());
  const SceneAnswer kept = client.describe_scene("office");
  EXPECT_THAT(state_says({"show", folder()}), HasSubstr("office"));
  EXPECT_THAT(state_says({"export", folder(), file("backup")}), HasSubstr("written"));
  ASSERT_TRUE(client.remove_object("office", "crate").ok());
  kill_daemon();
  EXPECT_THAT(state_says({"restore", file("backup"), folder()}, 2), HasSubstr(folder()))
      << "it would overwrite scenes";
  std::filesystem::rename(folder(), file("aside"));
  EXPECT_THAT(state_says({"restore", file("backup"), folder()}), HasSubstr("restored"));
  start();
  EXPECT_EQ(client.describe_scene("office").scene.digest, kept.scene.digest);
}

TEST_F(StateTest, TwoDaemonsDoNotShareAFolder) {
  start();
  Process second({CAMWAYD_BINARY, "--state", folder(), "--prefix", "OTHER", "--scene",
                  "office=" + scene_file("office")},
                 file("second.log"));
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr(folder()));
}

TEST_F(StateTest, ADamagedStoreIsRefused) {
  start();
  Client client(patient());
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(0.1 * i)).ok());
  }
  daemon().signal(SIGTERM);
  ASSERT_EQ(daemon().wait(), 0);
  const std::string store = folder() + "/scenes.sqlite";
  const auto size = std::filesystem::file_size(store);
  {
    std::fstream bytes(store, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(size / 2));
    bytes << std::string(4096, 'x');
  }
  Process refused(
      {CAMWAYD_BINARY, "--state", folder(), "--scene", "office=" + scene_file("office")},
      file("refused.log"));
  EXPECT_EQ(refused.wait(), 1);
  EXPECT_THAT(refused.output(), HasSubstr("camway state restore"));
  state_says({"check", folder()}, 2);
}

}  // namespace
}  // namespace camway::integration
