// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.h"
#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

/// Counts the requests that pass by on the network.
class RequestCounter {
 public:
  RequestCounter() {
    lcm_.subscribeFunction(wire::Channels{}.plan_request(), &RequestCounter::count, this);
  }
  int requests() {
    while (lcm_.handleTimeout(1) > 0) {
    }
    return requests_;
  }

 private:
  static void count(const lcm::ReceiveBuffer*, const std::string&, RequestCounter* self) {
    ++self->requests_;
  }
  lcm::LCM lcm_;
  int requests_ = 0;
};

class LifecycleTest : public IntegrationTest {};

TEST_F(LifecycleTest, ClientCarriesOnWhenTheDaemonIsKilledAndStartedAgain) {
  start_daemon();
  // The daemon stands still, so the request is certainly not answered when the daemon dies.
  daemon().signal(SIGSTOP);
  RequestCounter counter;
  const auto client = start_client("waiting", "office", {"office-free-door"});
  ASSERT_TRUE(eventually([&] { return counter.requests() > 0; })) << client->output();
  daemon().signal(SIGKILL);
  ASSERT_EQ(daemon().wait(), 128 + SIGKILL);
  ASSERT_TRUE(client->running());

  start_daemon();
  EXPECT_EQ(client->wait(), 0) << client->output();
  const std::vector<ClientLine> lines = lines_of(*client);
  ASSERT_EQ(lines.size(), 1u) << client->output();
  EXPECT_EQ(lines[0].status, "ok");
  EXPECT_GE(counter.requests(), 2);
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

  // Who was not answered is answered by the next daemon: nobody has to ask twice by hand.
  start_daemon();
  for (auto& client : clients) EXPECT_EQ(client->wait(), 0) << client->output();
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
