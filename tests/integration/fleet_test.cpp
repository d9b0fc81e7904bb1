// SPDX-License-Identifier: MIT
//
// Fleets of real processes: the same answers as of a daemon alone, whatever fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/fleet_fixture.h"
#include "tests/support/tcp_relay.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

Pose beside(double x_m) {
  Pose pose;
  pose.position_m = {x_m, 40.0, 0.0};
  return pose;
}

/// A mesh of about a megabyte, which is several messages to NATS.
SceneMesh large_mesh() {
  constexpr int kSide = 120;
  std::string text;
  for (int x = 0; x <= kSide; ++x) {
    for (int y = 0; y <= kSide; ++y) {
      text += "v " + std::to_string(0.1 * x) + " " + std::to_string(0.1 * y) + " " +
              std::to_string(0.01 * ((x * y) % 7)) + "\n";
    }
  }
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const int first = x * (kSide + 1) + y + 1;
      text += "f " + std::to_string(first) + " " + std::to_string(first + kSide + 1) + " " +
              std::to_string(first + kSide + 2) + " " + std::to_string(first + 1) + "\n";
    }
  }
  SceneMesh mesh;
  mesh.bytes.assign(text.begin(), text.end());
  mesh.format = "obj";
  return mesh;
}

/// Clients that ask a front without a pause, until they are told to stop, and compare each answer
/// with what is expected.
class Load {
 public:
  Load(int clients, std::map<std::string, std::string> expected) : expected_(std::move(expected)) {
    for (int i = 0; i < clients; ++i) threads_.emplace_back([this, i] { ask(i); });
  }
  ~Load() { stop(); }
  void stop() {
    ends_.store(true);
    threads_.clear();
  }
  [[nodiscard]] int answers() const { return answers_.load(); }

 private:
  void ask(int number) {
    ClientOptions options;
    options.retries = 1000;
    Client client(options);
    std::minstd_rand random(static_cast<unsigned>(number + 1));
    while (!ends_.load()) {
      const std::string& name = kOfficeRequests[random() % kOfficeRequests.size()];
      const PlanResponse answer = client.plan(request_of(name, "office"));
      EXPECT_EQ(bits_of(answer), expected_.at(name))
          << name << ": " << answer.error << answer.message;
      ++answers_;
    }
  }

  const std::map<std::string, std::string> expected_;
  std::atomic<bool> ends_ = false;
  std::atomic<int> answers_ = 0;
  std::vector<std::jthread> threads_;
};

class FleetFaultsTest : public FleetTest {
 protected:
  /// What a daemon alone answers.
  std::map<std::string, std::string> answers_of_one_daemon() {
    start_daemon_with_scenes({"office=" + scene_file("office")});
    Client client(patient());
    std::map<std::string, std::string> answers;
    for (const std::string& name : kOfficeRequests) {
      answers[name] = bits_of(client.plan(request_of(name, "office")));
    }
    stop_daemon();
    return answers;
  }
  /// Waits until a load has got so many more answers.
  static bool gets_answers(const Load& load, int more) {
    const int before = load.answers();
    return eventually([&] { return load.answers() >= before + more; });
  }
};

TEST_F(FleetFaultsTest, PlansAsADaemonAloneDoes) {
  const auto expected = answers_of_one_daemon();
  start_front();
  start_planners(3);
  Load load(3, expected);
  EXPECT_TRUE(gets_answers(load, 60));
  load.stop();
  Client client(patient());
  const DaemonStatus status = client.status(5.0);
  EXPECT_EQ(status.role, "front");
  EXPECT_EQ(status.planned_here, 0);
  EXPECT_EQ(status.differing_answers, 0);
  EXPECT_TRUE(status.daemon_start.durable);
}

TEST_F(FleetFaultsTest, PlannersThatAreKilledAreReplaced) {
  const auto expected = answers_of_one_daemon();
  start_front();
  start_planners(3);
  Load load(3, expected);
  for (int round = 0; round < 6; ++round) {
    const std::string victim = "p" + std::to_string(round % 3 + 1);
    EXPECT_TRUE(gets_answers(load, 5));
    planner(victim).signal(SIGKILL);
    EXPECT_EQ(planner(victim).wait(), 128 + SIGKILL);
    start_planner(victim);
  }
  load.stop();
  await_planners(3);
  EXPECT_EQ(Client(patient()).status(5.0).differing_answers, 0);
}

TEST_F(FleetFaultsTest, AStalledPlannerIsReplacedAndItsLateAnswersAreTheSame) {
  const auto expected = answers_of_one_daemon();
  start_front();
  start_planners(2);
  Load load(2, expected);
  EXPECT_TRUE(gets_answers(load, 4));
  planner("p1").signal(SIGSTOP);
  EXPECT_TRUE(gets_answers(load, 30));
  std::this_thread::sleep_for(std::chrono::seconds(10));
  planner("p1").signal(SIGCONT);
  EXPECT_TRUE(gets_answers(load, 10));
  load.stop();
  const DaemonStatus status = Client(patient()).status(5.0);
  EXPECT_EQ(status.differing_answers, 0);
  await_planners(2);
}

TEST_F(FleetFaultsTest, APlannerThatIsCutOffIsNotWaitedFor) {
  const auto expected = answers_of_one_daemon();
  testing::TcpRelay relay(server_.port());
  start_front();
  start_planner("far", "nats://127.0.0.1:" + std::to_string(relay.port()));
  await_planners(1);
  Client client(patient());
  Load load(1, expected);
  EXPECT_TRUE(gets_answers(load, 3));
  relay.cut();
  EXPECT_TRUE(gets_answers(load, 10)) << "the front plans by itself";
  load.stop();
  // The planner has to read what it missed before it plans again.
  const SceneAnswer crate = client.put_object("office", "crate", SceneBox{{1, 1, 1}}, beside(1.0));
  ASSERT_TRUE(crate.ok()) << crate.error;
  relay.mend();
  await_planners(1);
  const PlanResponse answer = client.plan(request_of("office-free-door", "office"));
  EXPECT_EQ(answer.scene_revision, crate.scene.revision);
  EXPECT_EQ(answer.scene_digest, crate.scene.digest);
}

TEST_F(FleetFaultsTest, AKilledServerLosesNothingAndStopsNoPlan) {
  const auto expected = answers_of_one_daemon();
  start_front();
  start_planners(2);
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  Load load(2, expected);
  std::int64_t acknowledged = client.describe_scene("yard").scene.revision;
  const SceneMesh large = large_mesh();
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(gets_answers(load, 3));
    std::jthread changes([&] {
      for (int i = 0; i < 30; ++i) {
        const SceneAnswer put =
            i % 10 == 0
                ? client.put_object("yard", "ground" + std::to_string(i), large, beside(0.1 * i))
                : client.put_object("yard", "crate", SceneBox{{1, 1, 1 + 0.01 * i}}, beside(0.0));
        ASSERT_TRUE(put.ok()) << put.error;
        ASSERT_EQ(put.scene.revision, acknowledged + 1) << "none is lost, none is made twice";
        acknowledged = put.scene.revision;
      }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + 30 * round));
    server_.kill();
    EXPECT_TRUE(gets_answers(load, 3)) << "the front plans by itself";
    server_.start();
  }
  load.stop();
  await_planners(2);
  PlanRequest walk;
  walk.scene = "yard";
  walk.least_revision = acknowledged;
  walk.keyframes.resize(2);
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  const PlanResponse answer = client.plan(walk);
  EXPECT_EQ(answer.scene_revision, acknowledged) << answer.error;
  EXPECT_EQ(answer.scene_digest, client.describe_scene("yard").scene.digest);
}

TEST_F(FleetFaultsTest, AClusterLosesItsLeaderAndTheFleetGoesOn) {
  const auto expected = answers_of_one_daemon();
  testing::NatsCluster cluster;
  servers_.clear();
  for (const std::string& url : cluster.urls()) servers_ += (servers_.empty() ? "" : ",") + url;
  // Servers on a busy machine take longer than their ten seconds to choose a leader.
  settings_ = "replicas = 3\npatience_s = 60.0\n";
  start_front();
  start_planners(2);
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  std::atomic<std::int64_t> acknowledged = client.describe_scene("yard").scene.revision;
  std::atomic<bool> ends = false;
  Load load(2, expected);
  std::jthread changes([&] {
    Client changer(patient());
    for (int i = 0; !ends; ++i) {
      const SceneAnswer put =
          changer.put_object("yard", "crate", SceneBox{{1, 1, 1 + 0.001 * i}}, beside(0.0));
      ASSERT_TRUE(put.ok()) << put.error;
      ASSERT_EQ(put.scene.revision, acknowledged + 1) << "none is lost, none is made twice";
      acknowledged = put.scene.revision;
    }
  });
  const auto makes_changes = [&] {
    const std::int64_t before = acknowledged;
    return eventually([&] { return acknowledged >= before + 10; });
  };
  EXPECT_TRUE(makes_changes());
  for (const char* const stream : {"camway_LOG", "camway_BLOBS"}) {
    testing::NatsServer& leader = cluster.first_leader_of(stream);
    leader.kill();
    EXPECT_TRUE(makes_changes());
    EXPECT_TRUE(gets_answers(load, 5));
    leader.start();
    EXPECT_TRUE(makes_changes());
  }
  ends = true;
  changes.join();
  load.stop();
  await_planners(2);
  const SceneAnswer yard = client.describe_scene("yard");
  EXPECT_EQ(yard.scene.revision, acknowledged);
  PlanRequest walk;
  walk.scene = "yard";
  walk.least_revision = acknowledged;
  walk.keyframes.resize(2);
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  EXPECT_EQ(client.plan(walk).scene_digest, yard.scene.digest);
  EXPECT_EQ(client.status(5.0).differing_answers, 0);
  // What is in the log is what the front has.
  front().signal(SIGTERM);
  EXPECT_EQ(front().wait(), 0);
  start_front();
  EXPECT_EQ(client.describe_scene("yard").scene.digest, yard.scene.digest);
}

TEST_F(FleetFaultsTest, AtTheLimitOfTheServerAnUnloadMakesRoom) {
  const auto expected = answers_of_one_daemon();
  server_.kill();
  server_.configure("jetstream { store_dir: \"STORE\", max_file_store: 12MB }\n");
  server_.start();
  // Contents that nothing needs are kept for four times that and ten seconds.
  settings_ = "patience_s = 2.0\n";
  start_front();
  start_planners(1);
  Client client(patient());
  for (const char* const scene : {"yard", "hall"}) ASSERT_TRUE(client.load_scene(scene, {}).ok());
  const auto put = [&](const std::string& scene, int number) {
    SceneMesh mesh = large_mesh();
    const std::string difference = "v 0 0 " + std::to_string(number) + "\n";
    mesh.bytes.insert(mesh.bytes.end(), difference.begin(), difference.end());
    const std::string triangle = "f 1 2 " + std::to_string(121 * 121 + 1) + "\n";
    mesh.bytes.insert(mesh.bytes.end(), triangle.begin(), triangle.end());
    return client.put_object(scene, "ground" + std::to_string(number), mesh, beside(0.0));
  };
  int meshes = 0;
  SceneAnswer full;
  for (; meshes < 100; ++meshes) {
    full = put("yard", meshes);
    if (!full.ok()) break;
  }
  EXPECT_EQ(full.status, Status::kLimit) << full.error;
  ASSERT_GT(meshes, 2);
  EXPECT_EQ(bits_of(client.plan(request_of("office-free-door", "office"))),
            expected.at("office-free-door"));
  const SceneAnswer removed = client.remove_object("yard", "ground0");
  EXPECT_TRUE(removed.ok()) << removed.error;
  const SceneAnswer unloaded = client.unload_scene("yard");
  EXPECT_TRUE(unloaded.ok()) << unloaded.error;
  EXPECT_TRUE(eventually([&] { return put("hall", 1000).ok(); }));
  EXPECT_TRUE(put("hall", 1001).ok());
  await_planners(1);
}

TEST_F(FleetFaultsTest, AKilledFrontHasTheSameScenesAgain) {
  start_front();
  start_planners(1);
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  std::int64_t acknowledged = client.describe_scene("yard").scene.revision;
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 5 + 5 * round; ++i) {
      const SceneAnswer put =
          client.put_object("yard", "crate", SceneBox{{1, 1, 1 + 0.01 * i}}, beside(0.1 * i));
      ASSERT_TRUE(put.ok()) << put.error;
      ASSERT_EQ(put.scene.revision, acknowledged + 1) << "none is lost, none is made twice";
      acknowledged = put.scene.revision;
    }
    front().signal(SIGKILL);
    EXPECT_EQ(front().wait(), 128 + SIGKILL);
    start_front();
  }
  EXPECT_EQ(client.describe_scene("yard").scene.revision, acknowledged);
  await_planners(1);
  EXPECT_EQ(client.plan(request_of("office-free-door", "office")).status, Status::kOk);
}

TEST_F(FleetFaultsTest, TwoFrontsChangeOneScene) {
  start_front("ONE");
  start_front("TWO");
  start_planner("p1");
  await_planners(1, "ONE");
  await_planners(1, "TWO");
  ASSERT_TRUE(Client(of_prefix("ONE")).load_scene("yard", {}).ok());
  ASSERT_TRUE(eventually([&] { return Client(of_prefix("TWO")).describe_scene("yard").ok(); }));
  constexpr int kChanges = 25;
  std::mutex mutex;
  std::vector<std::int64_t> revisions;
  {
    std::vector<std::jthread> writers;
    for (const std::string prefix : {"ONE", "TWO", "ONE", "TWO"}) {
      const int number = static_cast<int>(writers.size());
      writers.emplace_back([&, prefix, number] {
        Client client(of_prefix(prefix));
        for (int i = 0; i < kChanges; ++i) {
          const std::string name = "w" + std::to_string(number) + "c" + std::to_string(i);
          const SceneAnswer put = client.put_object("yard", name, SceneBox{{1, 1, 1}}, beside(i));
          ASSERT_TRUE(put.ok()) << prefix << ": " << put.error;
          const std::lock_guard lock(mutex);
          revisions.push_back(put.scene.revision);
        }
      });
    }
  }
  std::ranges::sort(revisions);
  EXPECT_EQ(std::ranges::adjacent_find(revisions), revisions.end()) << "each change has its own";
  Client one(of_prefix("ONE"));
  Client two(of_prefix("TWO"));
  ASSERT_TRUE(eventually([&] {
    return one.describe_scene("yard").scene.revision == two.describe_scene("yard").scene.revision;
  }));
  const SceneAnswer of_one = one.describe_scene("yard");
  const SceneAnswer of_two = two.describe_scene("yard");
  EXPECT_EQ(of_one.objects.size(), std::size_t{4} * kChanges);
  EXPECT_EQ(of_one.scene.digest, of_two.scene.digest);
  PlanRequest walk;
  walk.scene = "yard";
  walk.least_revision = of_one.scene.revision;
  walk.keyframes.resize(2);
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  EXPECT_EQ(two.plan(walk).scene_digest, of_one.scene.digest);
}

/// Beyond two summaries, or as CAMWAY_CHANGES says.
int many_changes() {
  const char* const said = std::getenv("CAMWAY_CHANGES");
  return said == nullptr ? 700 : std::atoi(said);
}

TEST_F(FleetFaultsTest, AFreshPlannerHasWhatManyChangesMade) {
  start_front();
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  SceneAnswer put;
  for (int i = 0; i < many_changes(); ++i) {
    put = client.put_object("yard", "crate", SceneBox{{1, 1, 1 + 0.001 * i}}, beside(0.01 * i));
    ASSERT_TRUE(put.ok()) << put.error;
  }
  start_planners(1);
  PlanRequest walk;
  walk.scene = "yard";
  walk.least_revision = put.scene.revision;
  walk.keyframes.resize(2);
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  const PlanResponse answer = client.plan(walk);
  EXPECT_EQ(answer.scene_digest, put.scene.digest);
  EXPECT_EQ(client.status(5.0).planned_here, 0);
}

TEST_F(FleetFaultsTest, AJumpOfAPlannersClockChangesNothing) {
#ifndef CAMWAY_JUMPING_CLOCK
  GTEST_SKIP() << "the clock of this test is a library that is loaded before a sanitizer's";
#else
  const auto expected = answers_of_one_daemon();
  start_front();
  write_file(file("offset"), "0");
  start_planner("p1", server_.url(),
                {"/usr/bin/env", std::string("LD_PRELOAD=") + CAMWAY_JUMPING_CLOCK,
                 "CAMWAY_CLOCK_OFFSET=" + file("offset")});
  await_planners(1);
  Load load(1, expected);
  EXPECT_TRUE(gets_answers(load, 3));
  for (const char* const ahead_s : {"86400", "-86400", "0"}) {
    write_file(file("offset"), ahead_s);
    EXPECT_TRUE(gets_answers(load, 5));
  }
  load.stop();
  EXPECT_EQ(Client(patient()).status(5.0).planned_here, 0);
#endif
}

TEST_F(FleetFaultsTest, ALoneFrontPlansByItself) {
  const auto expected = answers_of_one_daemon();
  start_front();
  Client client(patient());
  for (const std::string& name : kOfficeRequests) {
    EXPECT_EQ(bits_of(client.plan(request_of(name, "office"))), expected.at(name)) << name;
  }
  EXPECT_EQ(client.status(5.0).planned_here, static_cast<std::int64_t>(kOfficeRequests.size()));
}

TEST_F(FleetFaultsTest, AWatchedPathIsPlannedAgainByPlanners) {
  start_front();
  start_planners(2);
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  PlanRequest walk;
  walk.scene = "yard";
  walk.keyframes.resize(2);
  walk.keyframes[0].time_s = 0.0;
  walk.keyframes[1].time_s = 4.0;
  walk.keyframes[1].position_m = {4.0, 0.0, 0.0};
  std::mutex mutex;
  std::vector<WatchEvent> events;
  client.watch(walk, [&](const WatchEvent& event) {
    const std::lock_guard lock(mutex);
    events.push_back(event);
  });
  const auto answers = [&] {
    const std::lock_guard lock(mutex);
    return std::ranges::count(events, WatchEvent::Kind::kAnswer, &WatchEvent::kind);
  };
  ASSERT_TRUE(eventually([&] { return answers() == 1; }));
  Pose in_the_way;
  in_the_way.position_m = {2.0, 0.0, 0.0};
  ASSERT_TRUE(client.put_object("yard", "crate", SceneBox{{0.5, 0.5, 0.5}}, in_the_way).ok());
  ASSERT_TRUE(eventually([&] { return answers() == 2; }));
  EXPECT_EQ(client.status(5.0).planned_here, 0);
}

TEST_F(FleetTest, TheExampleScriptRunsAFleetAndStartsAPlannerAgain) {
  Process script(
      {FLEET_SCRIPT, "--folder", file("fleet"), "--port", std::to_string(testing::free_port()),
       "--bin", std::filesystem::path(CAMWAYD_BINARY).parent_path().string(), "--", "--scene",
       "office=" + scene_file("office")},
      file("fleet.log"));
  ASSERT_TRUE(eventually([&] {
    return !script.running() || script.output().find("fleet: ready") != std::string::npos;
  }));
  ASSERT_TRUE(script.running()) << script.output();
  await_planners(3);
  Client client(patient());
  EXPECT_EQ(client.plan(request_of("office-graze-column", "office")).status, Status::kOk);
  const std::int32_t victim = client.status(5.0).planners.front().pid;
  ::kill(victim, SIGKILL);
  ASSERT_TRUE(eventually([&] { return script.output().find("again") != std::string::npos; }));
  await_planners(3);
  EXPECT_EQ(client.status(5.0).planned_here, 0);
  script.signal(SIGTERM);
  EXPECT_EQ(script.wait(), 0) << script.output();
}

TEST_F(FleetTest, ASceneStaysWhileAFrontConfiguresIt) {
  start_front("ONE");
  start_front("TWO");
  front("ONE").signal(SIGTERM);
  ASSERT_EQ(front("ONE").wait(), 0);
  Process without({CAMWAYD_BINARY, "--role", "front", "--fleet", server_.url(), "--prefix", "ONE",
                   "--scene", "maze=" + scene_file("maze")},
                  file("without.log"));
  Client client(of_prefix("ONE"));
  ASSERT_TRUE(eventually([&] { return client.describe_scene("maze").ok(); }));
  EXPECT_THAT(without.output(), HasSubstr("scene kept: another front configures it"));
  EXPECT_TRUE(client.describe_scene("office").ok());
  EXPECT_TRUE(Client(of_prefix("TWO")).describe_scene("office").ok());
  without.signal(SIGTERM);
  EXPECT_EQ(without.wait(), 0);
}

TEST_F(FleetTest, AChangeThroughAnotherFrontIsKnownAtOnceAndLogged) {
  start_front("ONE");
  start_front("TWO");
  Client one(of_prefix("ONE"));
  Client two(of_prefix("TWO"));
  for (int i = 0; i < 30; ++i) {
    const std::string yard = "yard" + std::to_string(i);
    ASSERT_TRUE(one.load_scene(yard, {}).ok());
    const SceneAnswer put = two.put_object(yard, "crate", SceneBox{{1, 1, 1}}, beside(0.0));
    ASSERT_TRUE(put.ok()) << put.error;
    const SceneAnswer moved = one.move_object(yard, "crate", beside(1.0));
    ASSERT_TRUE(moved.ok()) << moved.error;
    ASSERT_TRUE(two.unload_scene(yard).ok());
    EXPECT_EQ(one.move_object(yard, "crate", beside(2.0)).status, Status::kUnknownScene);
  }
  EXPECT_THAT(front("TWO").output(), HasSubstr("a scene was changed in the fleet"));
  EXPECT_THAT(front("TWO").output(), HasSubstr("operation=move scene=yard0 object=crate"));
}

TEST_F(FleetTest, EveryFrontSendsTheTrianglesOfWhatOneOfThemGot) {
  start_front("ONE");
  start_front("TWO");
  Client one(of_prefix("ONE"));
  Client two(of_prefix("TWO"));
  const SceneAnswer put = one.put_object("office", "ball", SceneSphere{0.5, 0.0});
  ASSERT_TRUE(put.ok()) << put.error;
  const std::string digest = put.objects.at(0).digest;
  const SceneTriangles sent = one.object_triangles("office", digest);
  ASSERT_TRUE(sent.ok()) << sent.error;
  SceneTriangles other;
  EXPECT_TRUE(eventually([&] {
    other = two.object_triangles("office", digest);
    return other.ok();
  })) << other.error;
  EXPECT_GT(sent.triangles.size(), 100U);
  EXPECT_EQ(other.vertices_m, sent.vertices_m);
  EXPECT_EQ(other.triangles, sent.triangles);
}

}  // namespace
}  // namespace camway::integration
