// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/channels.h"
#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

/// Counts the messages on a channel.
class Counter {
 public:
  explicit Counter(const std::string& channel) {
    lcm_.subscribeFunction(channel, &Counter::count, this)->setQueueCapacity(10'000);
  }
  int messages() {
    while (lcm_.handleTimeout(1) > 0) {
    }
    return messages_;
  }

 private:
  static void count(const lcm::ReceiveBuffer*, const std::string&, Counter* self) {
    ++self->messages_;
  }
  lcm::LCM lcm_;
  int messages_ = 0;
};

class LifecycleTest : public IntegrationTest {
 protected:
  void kill_daemon() {
    daemon().signal(SIGKILL);
    ASSERT_EQ(daemon().wait(), 128 + SIGKILL);
  }
};

TEST_F(LifecycleTest, ClientCarriesOnWhenTheDaemonIsKilledAndStartedAgain) {
  start_daemon();
  // The daemon is stopped, so the request is not answered before the daemon is killed.
  daemon().signal(SIGSTOP);
  Counter counter(wire::Channels{}.plan_request());
  const auto client = start_client("waiting", "office", {"office-free-door"});
  ASSERT_TRUE(eventually([&] { return counter.messages() > 0; })) << client->output();
  kill_daemon();
  ASSERT_TRUE(client->running());

  start_daemon();
  EXPECT_EQ(client->wait(), 0) << client->output();
  const std::vector<ClientLine> lines = lines_of(*client);
  ASSERT_EQ(lines.size(), 1u) << client->output();
  EXPECT_EQ(lines[0].status, "ok");
  EXPECT_GE(counter.messages(), 2);
}

TEST_F(LifecycleTest, ClientCarriesOnWhenTheDaemonIsKilledInTheMiddleOfPlanning) {
  start_daemon({"--workers", "1"});
  Client client(patient());
  PlanRequest request = request_of("gallery-wall-slot", "gallery");  // takes longest
  request.deadline_s = 60.0;  // with a sanitizer it takes much longer still
  request.progress_period_s = 0.1;
  std::atomic<bool> is_being_planned = false;
  PlanHandlers handlers;
  handlers.on_progress = [&](const PlanProgress& progress) {
    if (progress.stage != PlanProgress::Stage::kWaiting) is_being_planned = true;
  };
  // Planning one takes less than the period of progress, so that most say nothing of it.
  constexpr int kRequests = 16;
  std::vector<PendingPlan> pending;
  for (int i = 0; i < kRequests; ++i) pending.push_back(client.plan_async(request, handlers));
  ASSERT_TRUE(eventually([&] { return is_being_planned.load(); }));
  kill_daemon();
  start_daemon();
  int most_tries = 0;
  const PlanResponse fresh = client.plan(request);
  ASSERT_TRUE(fresh.ok()) << fresh.error;
  for (PendingPlan& plan : pending) {
    const PlanResponse answer = plan.answer.get();
    ASSERT_TRUE(answer.ok()) << answer.error;
    EXPECT_EQ(answer.clearance_lower_bound_m, fresh.clearance_lower_bound_m);
    most_tries = std::max(most_tries, answer.tries);
  }
  EXPECT_GE(most_tries, 2);
}

TEST_F(LifecycleTest, AnUploadGoesOnWhenTheDaemonIsKilledInItsMiddle) {
  start_daemon();
  Counter pages(wire::Channels{}.upload());
  const SceneMesh mesh = long_mesh(20'000'000);
  Client client(patient());
  auto loaded = std::async(std::launch::async, [&] { return client.load_scene("world", mesh); });
  ASSERT_TRUE(eventually([&] { return pages.messages() > 30; }));
  kill_daemon();
  start_daemon();
  const SceneAnswer answer = loaded.get();
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.scene.num_triangles, 1);
}

/// The daemon has the complete upload and loses it when it is killed.
TEST_F(LifecycleTest, AnUploadBeginsAnewWhenTheDaemonIsKilledWhileItReadsIt) {
  start_daemon();
  Counter requests(wire::Channels{}.scene_request());
  const SceneMesh mesh = long_mesh(20'000'000);
  Client client(patient());
  auto loaded = std::async(std::launch::async, [&] { return client.load_scene("world", mesh); });
  ASSERT_TRUE(eventually([&] { return requests.messages() > 0; }));
  kill_daemon();
  start_daemon();
  const SceneAnswer answer = loaded.get();
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.scene.num_triangles, 1);
}

TEST_F(LifecycleTest, SigtermEndsAnIdleDaemonCleanly) {
  start_daemon();
  daemon().signal(SIGTERM);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
}

TEST_F(LifecycleTest, SigintDoesToo) {
  start_daemon();
  daemon().signal(SIGINT);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
}

TEST_F(LifecycleTest, SigtermEndsABusyDaemonCleanlyAndAnswersWhatItPlans) {
  start_daemon({"--workers", "1"});
  const std::vector<std::string> work{"office-wall-tour", "office-wall-rooms", "office-free-atrium",
                                      "office-graze-slalom"};
  std::vector<std::unique_ptr<Process>> clients;
  for (const std::string& request : work) {
    clients.push_back(start_client(request, "office", {request}));
  }
  Client listener;
  ASSERT_TRUE(eventually([&] {
    const DaemonStatus status = listener.status(0.2);
    return status.running_requests > 0 || status.answered_requests > 0;
  }));
  daemon().signal(SIGTERM);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();

  // The next daemon answers the requests that were not answered, without action of the user.
  start_daemon();
  for (auto& client : clients) EXPECT_EQ(client->wait(), 0) << client->output();
}

TEST_F(LifecycleTest, AChangeThatWaitsEndsWithTheDaemonAndSaysSo) {
  std::ofstream(file("camwayd.toml")) << "[scenes]\nmirror_voxels = 1000000000000\n";
  start_daemon({"--config", file("camwayd.toml")});
  ASSERT_TRUE(Client(patient()).load_scene("fine", {}, 0.002).ok());
  Counter counter(wire::Channels{}.scene_request());
  Process minutes(
      {CAMWAY_BINARY, "scene", "add", "fine", "hangar", "--box", "14,14,14", "--timeout-s", "600"},
      file("minutes.log"));
  ASSERT_TRUE(eventually([&] { return counter.messages() > 0; })) << minutes.output();
  daemon().signal(SIGTERM);
  EXPECT_EQ(daemon().wait(), 0) << daemon().output();
  EXPECT_EQ(minutes.wait(), 4) << minutes.output();
  EXPECT_THAT(minutes.output(), HasSubstr("the daemon is stopping; nothing was changed"));
}

TEST_F(LifecycleTest, ASecondDaemonSaysSoAndEndsUnlessItMayShareThePrefix) {
  start_daemon();
  const std::vector<std::string> command{CAMWAYD_BINARY, "--scene", "maze=" + scene_file("maze")};
  Process second(command, file("second.log"));
  EXPECT_EQ(second.wait(), 1) << second.output();
  EXPECT_THAT(second.output(), HasSubstr("another daemon serves with this prefix"));
  EXPECT_THAT(second.output(), HasSubstr("process " + std::to_string(daemon().pid())));
  EXPECT_THAT(second.output(), HasSubstr("--share-prefix"));
  EXPECT_TRUE(daemon().running()) << "the one that was there first";

  for (const std::string flags : {"--prefix=OTHER", "--share-prefix"}) {
    std::vector<std::string> allowed = command;
    allowed.push_back(flags);
    Process third(allowed, file(flags + ".log"));
    EXPECT_TRUE(eventually([&] { return third.output().find("ready") != std::string::npos; }))
        << third.output();
    third.signal(SIGTERM);
    EXPECT_EQ(third.wait(), 0) << third.output();
  }
}

TEST_F(LifecycleTest, OfTwoDaemonsThatStartAtOnceOneServes) {
  const std::vector<std::string> command{CAMWAYD_BINARY, "--scene", "maze=" + scene_file("maze")};
  Process one(command, file("one.log"));
  Process two(command, file("two.log"));
  ASSERT_TRUE(eventually([&] { return !one.running() || !two.running(); }));
  Process& loser = one.running() ? two : one;
  Process& winner = one.running() ? one : two;
  EXPECT_EQ(loser.wait(), 1) << loser.output();
  EXPECT_THAT(loser.output(), HasSubstr("another daemon serves with this prefix"));
  EXPECT_TRUE(eventually([&] { return Client().status(0.5).ok(); })) << winner.output();
  winner.signal(SIGTERM);
  EXPECT_EQ(winner.wait(), 0) << winner.output();
}

TEST_F(LifecycleTest, ADaemonThatWasJustKilledIsNoObstacle) {
  for (int i = 0; i < 3; ++i) {
    start_daemon();  // which waits until it serves
    kill_daemon();
  }
  start_daemon();
}

TEST_F(LifecycleTest, ClientsOnAnotherPrefixAreLeftAlone) {
  start_daemon({"--prefix", "OTHER"});
  ClientOptions options;
  options.prefix = "OTHER";
  Client other(options);
  EXPECT_TRUE(other.plan(request_of("office-free-door", "office")).ok());
  EXPECT_EQ(Client().status(1.5).status, Status::kNoDaemon);
}

}  // namespace
}  // namespace camway::integration
