// SPDX-License-Identifier: MIT
//
// A front as clients see it: the service over a fleet.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <thread>

#include <camway/cancel_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/status_t.hpp>
#include <camway/watch_report_t.hpp>

#include "daemon/messages/plan.h"
#include "tests/fleet/test_fleet.h"
#include "tests/messages/plan_samples.h"
#include "tests/service/running_service.h"

namespace camway::fleet {
namespace {

using testing::empty_scene;
using testing::eventually;
using testing::room_request;
using testing::TestPlanner;

constexpr std::uint64_t kFrontSeed = 20261129;

service::ServiceConfig front_config() {
  service::ServiceConfig config;
  config.workers = 1;
  config.most_jobs = 8;
  config.queue.jobs_of_a_client = 200;
  config.heartbeat_period = std::chrono::milliseconds(20);
  return config;
}

class FrontServiceTest : public ::testing::Test {
 protected:
  FrontServiceTest() {
    front_.follow(empty_scene("room"));
    front_.board.on_change(
        [this](int capacity) { daemon_.service().allow(std::max(1, capacity)); });
  }
  ~FrontServiceTest() override {
    for (TestPlanner& planner : planners_) planner.held.release();
    front_.board.on_change({});
  }

  TestPlanner& add(const std::string& id, int workers) {
    TestPlanner& planner = planners_.emplace_back(network_, id, workers);
    planner.follow(empty_scene("room"));
    planner.start();
    slots_ += workers;
    EXPECT_TRUE(eventually([&] { return front_.board.capacity() == slots_; }));
    return planner;
  }
  plan_request_t request(const std::string& client, std::int64_t id) {
    return room_request(client, id, random_);
  }
  std::size_t answers_to(const std::string& client) {
    return daemon_.transport.published_on(daemon_.channels.plan_response(client)).size();
  }
  /// Returns how many answers to one client were sent before the last one to another.
  std::size_t answers_before_last_to(const std::string& last, const std::string& client) {
    std::size_t answers = 0;
    std::size_t before = 0;
    for (const auto& message : daemon_.transport.published()) {
      if (message.channel == daemon_.channels.plan_response(client)) ++answers;
      if (message.channel == daemon_.channels.plan_response(last)) before = answers;
    }
    return before;
  }

  testing::Random random_{kFrontSeed};
  testing::MemoryNetwork network_;
  std::deque<TestPlanner> planners_;
  testing::TestFront front_{network_, "front"};
  testing::RunningService daemon_{
      front_config(), std::shared_ptr<service::PlanAnswerer>(front_.answerer.get(), [](auto*) {})};
  int slots_ = 0;
};

TEST_F(FrontServiceTest, AnswersClientsByItsPlanners) {
  add("a", 1);
  const plan_request_t wanted = request("client", 1);
  daemon_.send(wanted);
  const auto answer = daemon_.answer_to(wanted);
  ASSERT_TRUE(answer);
  EXPECT_EQ(testing::timeless(*answer), testing::timeless(front_.local(wanted)));
  EXPECT_EQ(planners_[0].held.calls(), 1);
}

TEST_F(FrontServiceTest, AsManyRunAsThePlannersHaveSlots) {
  TestPlanner& a = add("a", 2);
  a.held.hold();
  for (int id = 1; id <= 6; ++id) daemon_.send(request("client", id));
  ASSERT_TRUE(a.held.wait_for_calls(2));
  TestPlanner& b = planners_.emplace_back(network_, "b", 3);
  b.held.hold();
  b.follow(empty_scene("room"));
  b.start();
  ASSERT_TRUE(b.held.wait_for_calls(3)) << "the next begin when there is more room";
  EXPECT_EQ(a.held.calls(), 2);
  EXPECT_TRUE(daemon_.transport.wait_until([&](const auto& messages) {
    if (messages.back().channel != daemon_.channels.status()) return false;
    const auto status = wire::decode<status_t>(messages.back().bytes);
    return status.message->num_workers == 5 && status.message->running_requests == 5 &&
           status.message->queued_requests == 1;
  }));
  a.held.release();
  b.held.release();
  EXPECT_TRUE(eventually([&] { return answers_to("client") == 6; }));
}

TEST_F(FrontServiceTest, AClientWithOneRequestIsNextBesideOneWithMany) {
  TestPlanner& a = add("a", 1);
  for (const char* client : {"many", "one"}) {  // both are known
    const plan_request_t first = request(client, 1);
    daemon_.send(first);
    ASSERT_TRUE(daemon_.answer_to(first));
  }
  a.held.hold();
  for (int id = 2; id <= 101; ++id) daemon_.send(request("many", id));
  ASSERT_TRUE(a.held.wait_for_calls(3));
  const plan_request_t wanted = request("one", 2);
  daemon_.send(wanted);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  a.held.release();
  ASSERT_TRUE(daemon_.answer_to(wanted));
  EXPECT_LE(answers_before_last_to("one", "many"), 1U + 4U) << "the one that ran, and few more";
  EXPECT_TRUE(eventually([&] { return answers_to("many") == 101; }));
}

TEST_F(FrontServiceTest, ProgressAndCancelsReachTheClientAndThePlanner) {
  TestPlanner& a = add("a", 1);
  a.held.hold();
  plan_request_t wanted = request("client", 1);
  wanted.progress_period_s = 0.1;
  daemon_.send(wanted);
  const std::string channel = daemon_.channels.plan_progress("client");
  EXPECT_TRUE(daemon_.transport.wait_until([&](const auto& messages) {
    return std::ranges::any_of(messages, [&](const auto& message) {
      if (message.channel != channel) return false;
      const auto progress = wire::decode<plan_progress_t>(message.bytes);
      return progress.message->stage == plan_progress_t::CORRECTING &&
             progress.message->num_collisions == 5 && progress.message->num_corrected == 2;
    });
  }));
  cancel_t cancel{};
  cancel.client_id = "client";
  cancel.request_id = 1;
  daemon_.send_on(daemon_.channels.cancel(), wire::encode(cancel));
  EXPECT_EQ(daemon_.answer_to(wanted)->status, plan_response_t::STATUS_CANCELLED);
  EXPECT_TRUE(eventually([&] { return a.server->running() == 0; }));
}

TEST_F(FrontServiceTest, WatchesThePathsOfItsPlanners) {
  add("a", 1);
  plan_request_t wanted = request("client", 1);
  wanted.watch_lease_s = 30.0;
  daemon_.send(wanted);
  const auto answer = daemon_.answer_to(wanted);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, plan_response_t::STATUS_OK);
  const auto report = daemon_.transport.message_on(daemon_.channels.watch_report("client"), 0);
  ASSERT_TRUE(report);
  const auto decoded = wire::decode<watch_report_t>(*report);
  ASSERT_EQ(decoded.message->paths.size(), 1U);
  EXPECT_EQ(decoded.message->paths[0].state, path_state_t::FREE);
  EXPECT_EQ(decoded.message->paths[0].answer_revision, answer->scene_revision);
}

}  // namespace
}  // namespace camway::fleet
