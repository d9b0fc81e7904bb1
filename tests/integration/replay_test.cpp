// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++found;
  }
  return found;
}

/// A session that lcm-logger recorded.
class ReplayTest : public IntegrationTest {
 protected:
  void record_session() {
    start_daemon();
    Process logger({LCM_LOGGER_BINARY, "--quiet", "--force", "--flush-interval=50", log_},
                   file("logger.log"));
    // The logger is ready when the first heartbeat is in the file.
    ASSERT_TRUE(eventually([&] { return count(read_file(log_), "CAMWAY_STATUS") > 0; }))
        << logger.output();
    const auto a = start_client("recorded-a", "office",
                                {"office-free-door", "office-graze-door", "office-free-timed"});
    const auto b = start_client("recorded-b", "maze", {"maze-free-cells", "maze-wall-neighbours"});
    ASSERT_EQ(a->wait(), 0) << a->output();
    ASSERT_EQ(b->wait(), 0) << b->output();
    ASSERT_TRUE(eventually([&] {
      const std::string text = read_file(log_);
      return count(text, "CAMWAY_PLAN_RESPONSE_recorded-a") >= 3 &&
             count(text, "CAMWAY_PLAN_RESPONSE_recorded-b") >= 2;
    }));
    logger.signal(SIGTERM);
    ASSERT_TRUE(logger.wait());
    daemon().signal(SIGTERM);
    ASSERT_EQ(daemon().wait(), 0) << daemon().output();
  }

  std::string log_;

  void SetUp() override {
    IntegrationTest::SetUp();
    log_ = file("session.lcmlog");
  }
};

TEST_F(ReplayTest, ARecordedSessionReplaysClean) {
  record_session();
  if (HasFatalFailure()) return;
  Process replay({CAMWAY_BINARY, "replay", log_, "--scene", "office=" + scene_file("office"),
                  "--scene", "maze=" + scene_file("maze")},
                 file("replay.log"));
  EXPECT_EQ(replay.wait(), 0) << replay.output();
  EXPECT_THAT(replay.output(), HasSubstr("recorded-a"));
  EXPECT_THAT(replay.output(), HasSubstr("recorded-b"));

  // With another scene the replay must report a difference.
  Process wrong({CAMWAY_BINARY, "replay", log_, "--scene", "office=" + scene_file("gallery"),
                 "--scene", "maze=" + scene_file("maze")},
                file("wrong.log"));
  EXPECT_EQ(wrong.wait(), 3) << wrong.output();
}

TEST_F(ReplayTest, ReplayIsBitIdenticalForAnyNumberOfThreads) {
  record_session();
  if (HasFatalFailure()) return;
  for (const std::string threads : {"1", "4"}) {
    Process replay({CAMWAY_BINARY, "replay", log_, "--scene", "office=" + scene_file("office"),
                    "--scene", "maze=" + scene_file("maze"), "--threads", threads, "--responses",
                    file("responses-" + threads), "--no-timing"},
                   file("replay-" + threads + ".log"));
    ASSERT_EQ(replay.wait(), 0) << replay.output();
  }
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(file("responses-1"))) {
    const std::string one = read_file(entry.path().string());
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, read_file(file("responses-4") + "/" + entry.path().filename().string()));
    ++compared;
  }
  EXPECT_EQ(compared, 5u);
}

TEST_F(ReplayTest, APublishedSessionChangesTheScenesOfAnotherDaemon) {
  start_daemon_with_scenes({"office=" + scene_file("office")}, {"--record", file("recorded")});
  std::string digest;
  {
    Client client(patient());
    SceneMesh mesh = long_mesh(300'000);  // an upload of several pages
    Pose pose;
    ASSERT_TRUE(client.put_object("office", "crate", mesh, pose).ok());
    pose.position_m = {30.0, 0.0, 0.0};
    const SceneAnswer moved = client.move_object("office", "crate", pose);
    ASSERT_TRUE(moved.ok()) << moved.message;
    digest = moved.scene.digest;
  }
  daemon().signal(SIGTERM);
  ASSERT_EQ(daemon().wait(), 0) << daemon().output();

  start_daemon_with_scenes({"office=" + scene_file("office")});
  for (const std::string turn : {"first", "second"}) {
    Process publish(
        {CAMWAY_BINARY, "replay", file("recorded"), "--publish", "--speed", "0", "--wait-s", "60"},
        file("publish-" + turn + ".log"));
    EXPECT_EQ(publish.wait(), 0) << publish.output();
    EXPECT_THAT(publish.output(), HasSubstr("2 of 2 changes of scenes made"));
  }
  Client client(patient());
  const SceneAnswer scene = client.describe_scene("office");
  EXPECT_EQ(scene.scene.digest, digest);
  EXPECT_EQ(scene.scene.revision, 5U) << "of the file, and twice a mesh and its move";
}

}  // namespace
}  // namespace camway::integration
