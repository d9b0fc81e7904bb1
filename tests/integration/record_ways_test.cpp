// SPDX-License-Identifier: MIT
//
// Sessions of every kind of daemon and log, which are recorded and replayed.
#include <camway/authentication.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/integration/fleet_fixture.h"

namespace camway::integration {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::array<const char*, 3> kDoors{"office-free-door", "office-graze-door",
                                            "office-graze-column"};
/// The way through the door.
constexpr std::array<double, 3> kDoorway_m{9.75, 1.5, 7.3};

Pose beside_door(double aside_m) {
  Pose pose;
  pose.position_m = {kDoorway_m[0] + aside_m, kDoorway_m[1], kDoorway_m[2]};
  return pose;
}

/// Runs `camway` and lcm-logger for tests that have processes of their own.
class Recording {
 public:
  explicit Recording(std::string folder) : folder_(std::move(folder)) {}

  /// Returns exit code and output of `camway` with these arguments.
  std::pair<int, std::string> camway(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CAMWAY_BINARY);
    Process process(arguments, folder_ + "/said-" + std::to_string(++said_) + ".log");
    const int code = process.wait().value_or(-1);
    return {code, process.output()};
  }

  /// Starts lcm-logger, and waits until it hears the daemon with this prefix.
  void start_logger(const std::string& prefix = "CAMWAY") {
    logger_ =
        std::make_unique<Process>(std::vector<std::string>{LCM_LOGGER_BINARY, "--quiet", "--force",
                                                           "--flush-interval=50", log()},
                                  folder_ + "/logger.log");
    ASSERT_TRUE(
        eventually([&] { return read_file(log()).find(prefix + "_STATUS") != std::string::npos; }));
  }
  void stop_logger() {
    logger_->signal(SIGTERM);
    ASSERT_TRUE(logger_->wait());
  }
  [[nodiscard]] std::string log() const { return folder_ + "/plain.lcmlog"; }

  /// Checks that all requests of a session replay with the same bits.
  void expect_same(std::vector<std::string> arguments, std::size_t requests) {
    arguments.insert(arguments.begin(), "replay");
    arguments.insert(arguments.end(), {"--no-timing", "--threads", "2"});
    const auto [code, text] = camway(arguments);
    EXPECT_EQ(code, 0) << text;
    EXPECT_THAT(text, HasSubstr("verdict: SAME: " + std::to_string(requests) +
                                " requests: " + std::to_string(requests) + " same,"));
  }

 private:
  std::string folder_;
  int said_ = 0;
  std::unique_ptr<Process> logger_;
};

class RecordWaysTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    recording_ = std::make_unique<Recording>(file(""));
  }
  void stop() {
    daemon().signal(SIGTERM);
    ASSERT_EQ(daemon().wait(), 0) << daemon().output();
  }
  std::string scenes() const { return fs::path(scene_file("office")).parent_path(); }

  std::unique_ptr<Recording> recording_;
};

/// A start that can never record is not tried again: the unit restarts after 1, and not after 2.
TEST_F(RecordWaysTest, AFolderThatCannotBeMadeIsAFaultOfTheConfiguration) {
  std::ofstream(file("taken")) << "no folder";
  Process daemon({CAMWAYD_BINARY, "--scene-roots", scenes(), "--record", file("taken") + "/below"},
                 file("refused.log"));
  EXPECT_EQ(daemon.wait(), 2);
  EXPECT_THAT(daemon.output(), HasSubstr("nothing can be recorded"));
}

/// Clients load files below the daemon's scene roots, put one as an object, and replace a scene.
TEST_F(RecordWaysTest, FilesOfSceneRoots) {
  start_daemon_with_scenes(
      {}, {"--scene-roots", scenes(), "--record", file("recorded"), "--workers", "2"});
  recording_->start_logger();
  Client client(patient());
  SceneMesh office;
  office.file = "office.obj";
  ASSERT_TRUE(client.load_scene("office", office).ok());
  int plans = 0;
  const auto plan = [&] {
    for (const char* door : kDoors) client.plan(request_of(door, "office"));
    plans += static_cast<int>(kDoors.size());
  };
  plan();
  SceneMesh maze;
  maze.file = "maze.obj";
  maze.scale = 0.01;
  ASSERT_TRUE(client.put_object("office", "toy", maze, beside_door(0.0)).ok());
  plan();
  ASSERT_TRUE(client.move_object("office", "toy", beside_door(0.3)).ok());
  plan();
  maze.scale = 1.0;
  ASSERT_TRUE(client.load_scene("office", maze).ok());
  plan();
  ASSERT_TRUE(client.unload_scene("office").ok());
  ASSERT_TRUE(client.load_scene("office", office).ok());
  plan();
  stop();
  recording_->stop_logger();
  const auto requests = static_cast<std::size_t>(plans);
  recording_->expect_same({file("recorded")}, requests);
  recording_->expect_same({recording_->log(), "--root", scenes()}, requests);
  const std::string pack = file("roots.camway-session");
  const auto [packed, text] =
      recording_->camway({"pack", recording_->log(), "--root", scenes(), "-o", pack});
  EXPECT_EQ(packed, 0) << text;
  recording_->expect_same({pack}, requests);
}

/// A session of a daemon that accepts only signed messages.
TEST_F(RecordWaysTest, SignedMessages) {
  const auto write_keys = [&](const std::string& name, char digit) {
    std::ofstream(file(name)) << "1 " + std::string(64, digit) + "\n";
    EXPECT_EQ(chmod(file(name).c_str(), 0600), 0);
    return file(name);
  };
  const std::string keys = write_keys("keys", '1');
  const std::string other_keys = write_keys("other", '2');
  std::ofstream(file("camwayd.toml")) << "[auth]\nkey_file = \"keys\"\n";
  start_daemon_with_scenes({"office=" + scene_file("office")},
                           {"--config", file("camwayd.toml"), "--record", file("recorded")});
  recording_->start_logger();
  ClientOptions options = patient();
  options.authentication = authentication_from(keys).authentication;
  Client client(options);
  for (int i = 0; i < 4; ++i) {
    for (const char* door : kDoors) client.plan(request_of(door, "office"));
    ASSERT_TRUE(
        client.put_object("office", "crate", SceneBox{{0.4, 0.4, 0.4}}, beside_door(0.2 * i)).ok());
  }
  stop();
  recording_->stop_logger();
  for (const std::string& session : {file("recorded"), recording_->log()}) {
    recording_->expect_same({session, "--root", scenes()}, 12);
    recording_->expect_same({session, "--root", scenes(), "--key-file", keys}, 12);
    const auto [code, text] = recording_->camway({"replay", session, "--key-file", other_keys});
    EXPECT_EQ(code, 2);
    EXPECT_THAT(text, HasSubstr("are not signed with a key of"));
    const std::string pack = file("signed.camway-session");
    const auto [packed, said] =
        recording_->camway({"pack", session, "--root", scenes(), "--key-file", keys, "-o", pack,
                            "--from", "0", "--status", "ok,partial,infeasible,timeout"});
    EXPECT_EQ(packed, 0) << said;
    recording_->expect_same({pack, "--key-file", keys}, 12);
  }
}

class RecordFleetTest : public FleetTest {
 protected:
  void SetUp() override {
    FleetTest::SetUp();
    recording_ = std::make_unique<Recording>(file(""));
  }
  void stop(const std::string& prefix) {
    front(prefix).signal(SIGTERM);
    ASSERT_EQ(front(prefix).wait(), 0) << front(prefix).output();
  }

  /// Changes the office through this front, and plans through it all the while. Returns the last
  /// revision that it made.
  std::int64_t work_through(const std::string& prefix, int rounds) const {
    std::int64_t last = 0;
    Client painter(of_prefix(prefix));
    Client planner(of_prefix(prefix));
    for (int i = 0; i < rounds; ++i) {
      std::vector<PendingPlan> pending;
      for (const char* door : kDoors)
        pending.push_back(planner.plan_async(request_of(door, "office")));
      const std::string crate = "crate-" + prefix + std::to_string(i % 2);
      const SceneAnswer put =
          painter.put_object("office", crate, SceneBox{{0.3, 0.3, 0.3}},
                             beside_door(0.1 * i + (prefix == "ONE" ? 0.0 : 9.0)));
      EXPECT_TRUE(put.ok()) << put.error;
      last = put.scene.revision;
      for (PendingPlan& plan : pending) plan.answer.get();
    }
    return last;
  }

  /// Waits until this front has a revision of the office: until then, planners may be ahead of it,
  /// and one that is stopped records no more.
  static void await_revision(const std::string& prefix, std::int64_t revision) {
    Client client(of_prefix(prefix));
    ASSERT_TRUE(
        eventually([&] { return client.describe_scene("office").scene.revision >= revision; }));
  }

  std::unique_ptr<Recording> recording_;
};

/// Two fronts change one scene, planners answer, and each front records. A recording has the
/// changes of both.
TEST_F(RecordFleetTest, FrontsRecordTheChangesOfOneAnother) {
  constexpr int kRounds = 12;
  constexpr std::size_t kRequests = kRounds * kDoors.size();
  start_front("ONE", {"--record", file("one")});
  start_front("TWO", {"--record", file("two")});
  start_planner("p1");
  start_planner("p2");
  await_planners(2, "ONE");
  await_planners(2, "TWO");
  recording_->start_logger("ONE");
  // The first answer is of the scene as its file has it: by that digest replay finds the file for
  // the plain log.
  Client(of_prefix("ONE")).plan(request_of(kDoors[0], "office"));
  std::int64_t last = 0;
  {
    std::jthread other([&] { last = work_through("TWO", kRounds); });
    work_through("ONE", kRounds);
  }
  // Two more rounds through ONE: the first plans with the last change of TWO, the second with a
  // change of ONE after it.
  await_revision("ONE", last);
  await_revision("TWO", work_through("ONE", 2));
  stop("ONE");
  stop("TWO");
  recording_->stop_logger();
  recording_->expect_same({file("one"), "--prefix", "ONE"}, 1 + kRequests + 2 * kDoors.size());
  recording_->expect_same({file("two"), "--prefix", "TWO"}, kRequests);
  const std::string pack = file("part.camway-session");
  const auto [packed, said] = recording_->camway(
      {"pack", file("one"), "--prefix", "ONE", "--from", "0", "--status", "ok", "-o", pack});
  EXPECT_EQ(packed, 0) << said;
  const auto [part, part_text] =
      recording_->camway({"replay", pack, "--prefix", "ONE", "--no-timing"});
  EXPECT_EQ(part, 0) << part_text;
  EXPECT_THAT(part_text, AllOf(HasSubstr("verdict: SAME: "), HasSubstr(" 0 not compared")));

  // A plain log has the messages of one front: it cannot know what the other one changed.
  const std::string scenes = fs::path(scene_file("office")).parent_path();
  const auto [code, text] = recording_->camway(
      {"replay", recording_->log(), "--prefix", "ONE", "--root", scenes, "--no-timing"});
  EXPECT_THAT(text, AllOf(HasSubstr(" 0 better, 0 different, 0 worse, 0 regressed, "),
                          HasSubstr("it has other triangles now"),
                          HasSubstr("of 'office' is not in the log")));
  EXPECT_EQ(code, 0) << text;
}

/// The plain log of a fleet with one front has all that a replay needs.
TEST_F(RecordFleetTest, APlainLogOfAFleetReplays) {
  constexpr int kRounds = 6;
  start_front("ONE");
  start_planner("p1");
  start_planner("p2");
  await_planners(2, "ONE");
  recording_->start_logger("ONE");
  work_through("ONE", kRounds);
  stop("ONE");
  recording_->stop_logger();
  const std::string scenes = fs::path(scene_file("office")).parent_path();
  recording_->expect_same({recording_->log(), "--prefix", "ONE", "--root", scenes},
                          kRounds * kDoors.size());
}

}  // namespace
}  // namespace camway::integration
