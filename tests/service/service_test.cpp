// SPDX-License-Identifier: MIT
#include "daemon/service/service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <semaphore>
#include <thread>

#include <camway/error_t.hpp>
#include <camway/status_t.hpp>
#include <camway/watch_report_t.hpp>

#include "daemon/messages/plan.h"
#include "daemon/service/heartbeat.h"
#include "daemon/version/version.h"
#include "tests/messages/message_mutation.h"
#include "tests/messages/plan_samples.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using testing::kSeed;
using testing::mutate;
using testing::Random;
using testing::request_with;
using testing::RunningService;

/// Returns a configuration with frequent heartbeats, to keep tests short.
ServiceConfig quick_heartbeats() {
  ServiceConfig config;
  config.heartbeat_period = std::chrono::milliseconds(20);
  return config;
}

template <class Message>
Message decoded(const Bytes& bytes) {
  wire::Decoded<Message> result = wire::decode<Message>(bytes);
  EXPECT_TRUE(result.message) << result.fault.text("");
  return result.message.value_or(Message{});
}

/// Returns the first status for which `enough` is true.
std::optional<status_t> status_with(const RunningService& daemon,
                                    const std::function<bool(const status_t&)>& enough) {
  std::optional<status_t> found;
  const bool came = daemon.transport.wait_until([&](const auto& messages) {
    const auto& last = std::find_if(messages.rbegin(), messages.rend(), [&](const auto& message) {
      return message.channel == daemon.channels.status();
    });
    if (last == messages.rend()) return false;
    found = decoded<status_t>(last->bytes);
    return enough(*found);
  });
  return came ? found : std::nullopt;
}

TEST(Service, PublishesAStatusAtOnceAndGoesOn) {
  const RunningService daemon(quick_heartbeats());
  ASSERT_TRUE(daemon.transport.wait_for_messages_on("CAMWAY_STATUS", 3));
  const auto status = decoded<status_t>(daemon.transport.published_on("CAMWAY_STATUS").front());
  EXPECT_EQ(status.version, kVersion);
  EXPECT_EQ(status.num_workers, 1);
  ASSERT_EQ(status.num_scenes, 2);
  EXPECT_EQ(status.total_scenes, 2);
  EXPECT_EQ(status.scenes[0].name, "hall");
  EXPECT_EQ(status.scenes[1].name, "room");
  EXPECT_EQ(status.scenes[1].revision, 7);
  EXPECT_EQ(status.scenes[1].occupancy_resolution_m, 0.0);
  EXPECT_NE(daemon.log_text().find("ready"), std::string::npos);
}

TEST(Service, CountsAnswersByStatusLatenciesAndTraffic) {
  std::atomic<int> statuses = 0;
  ServiceHooks hooks;
  hooks.status = [&](status_t& status) { status.crowded_messages = ++statuses; };
  RunningService daemon(quick_heartbeats(), testing::echo_result, hooks);
  for (const std::int64_t id : {1, 2}) {
    daemon.send(request_with(id));
    ASSERT_TRUE(daemon.answer_to(request_with(id)));
  }
  daemon.send(request_with(1));  // from the cache
  plan_request_t elsewhere = request_with(3);
  elsewhere.scene = "nowhere";
  daemon.send(elsewhere);
  const std::optional<status_t> status = status_with(daemon, [](const status_t& s) {
    // An answer is counted before it is sent, and a status after it was sent.
    return s.answered_requests == 4 && s.sent_messages >= 5;
  });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->cache_hits, 1);
  EXPECT_EQ(status->repeated_requests, 1);
  EXPECT_EQ(status->plan_answers[plan_response_t::STATUS_OK], 2);
  EXPECT_EQ(status->plan_answers[plan_response_t::STATUS_UNKNOWN_SCENE], 1);
  EXPECT_EQ(status->receipt_to_answer.count, 3);
  EXPECT_EQ(status->waiting.count, 2);
  EXPECT_EQ(status->planning.count, 2);
  EXPECT_GE(status->receipt_to_answer.sum_s, status->waiting.sum_s);
  EXPECT_EQ(status->received_messages, 4);
  EXPECT_GT(status->received_bytes, 0);
  EXPECT_GT(status->sent_bytes, 0);
  EXPECT_GT(status->crowded_messages, 0) << "what the hook adds";
}

TEST(Service, TellsWhenItIsReadyAndWhenItStops) {
  std::atomic<bool> ready = false;
  std::atomic<bool> stopping = false;
  ServiceHooks hooks;
  hooks.ready = [&] { ready = true; };
  hooks.stopping = [&] { stopping = true; };
  RunningService daemon({}, testing::echo_result, hooks);
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.answer_to(request_with(1)));
  EXPECT_TRUE(ready);
  EXPECT_FALSE(stopping);
  daemon.stop();
  EXPECT_TRUE(stopping);
}

TEST(Service, IsAliveUntilAWorkerHangs) {
  std::counting_semaphore<> alive(0);
  ServiceHooks hooks;
  hooks.alive = [&] { alive.release(); };
  hooks.alive_period = std::chrono::milliseconds(1);
  hooks.stuck_after = std::chrono::milliseconds(50);
  ServiceConfig config;
  config.deadline = {1.0, 1.0};
  RunningService daemon(config, testing::echo_result, hooks);
  for (int i = 0; i < 5; ++i) alive.acquire();

  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  while (daemon.log_text().find("warning a worker hangs at one request") == std::string::npos) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  while (alive.try_acquire()) {
  }
  EXPECT_FALSE(alive.try_acquire_for(std::chrono::milliseconds(50)));
  daemon.planner.release();
  alive.acquire();
}

TEST(Service, UsesItsPrefixForEveryChannel) {
  ServiceConfig config;
  config.prefix = "CW_TEST-1";
  RunningService daemon(config);
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.answer_to(request_with(1)));
  for (const auto& message : daemon.transport.published()) {
    EXPECT_EQ(message.channel.rfind("CW_TEST-1_", 0), 0U) << message.channel;
  }
}

struct BrokenMessage {
  const char* what;
  Bytes bytes;
};

/// Returns broken requests whose sender can still be read.
std::vector<BrokenMessage> broken_but_addressed() {
  const Bytes good = wire::encode(request_with(77));
  Bytes truncated = good;
  truncated.resize(good.size() - 1);
  Bytes trailing = good;
  trailing.push_back(1);
  plan_request_t page = request_with(77);
  page.page = 9;
  plan_request_t long_scene = request_with(77);
  long_scene.scene = std::string(500, 's');
  plan_request_t too_large = request_with(77, 1500);
  return {{"truncated", truncated},
          {"trailing byte", trailing},
          {"page 9 of 1", wire::encode(page)},
          {"long scene name", wire::encode(long_scene)},
          {"more than 59,900 bytes", wire::encode(too_large)}};
}

TEST(Service, AnswersMalformedRequestsToTheirSender) {
  RunningService daemon;
  std::size_t answers = 0;
  for (const BrokenMessage& broken : broken_but_addressed()) {
    SCOPED_TRACE(broken.what);
    daemon.send_on(daemon.channels.plan_request(), broken.bytes);
    const std::optional<plan_response_t> answer = daemon.answer_to(request_with(77), answers++);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, plan_response_t::STATUS_MALFORMED);
    EXPECT_EQ(answer->message.rfind("plan_request_t", 0), 0U) << answer->message;
  }
  EXPECT_TRUE(daemon.transport.published_on(daemon.channels.error()).empty());
  daemon.send(request_with(77));
  EXPECT_EQ(daemon.answer_to(request_with(77), answers)->status, plan_response_t::STATUS_OK)
      << "a malformed message uses up no id";
}

TEST(Service, ReportsWhatCannotBeAnswered) {
  ServiceConfig config = quick_heartbeats();
  config.log_limits = {.lines_per_s = 1e-3, .burst_lines = 1.0};
  RunningService daemon(config);
  plan_request_t nameless = request_with(1);
  nameless.client_id = "";
  plan_request_t injection = request_with(1);
  injection.client_id = "x/../STATUS";
  const std::vector<BrokenMessage> messages{
      {"nothing", {}},
      {"seven bytes", Bytes(7, 0)},
      {"no client id", wire::encode(nameless)},
      {"a client id that is no name", wire::encode(injection)},
      {"another type", wire::encode(status_t{})},
  };
  std::size_t errors = 0;
  for (const BrokenMessage& broken : messages) {
    SCOPED_TRACE(broken.what);
    daemon.send_on(daemon.channels.plan_request(), broken.bytes);
    ASSERT_TRUE(daemon.transport.wait_for_messages_on(daemon.channels.error(), ++errors));
    const auto error =
        decoded<error_t>(daemon.transport.published_on(daemon.channels.error()).back());
    EXPECT_EQ(error.channel, daemon.channels.plan_request());
    EXPECT_EQ(error.size_bytes, static_cast<std::int64_t>(broken.bytes.size()));
    EXPECT_FALSE(error.message.empty());
  }
  EXPECT_TRUE(status_with(daemon, [&](const status_t& status) {
    return status.malformed_messages == static_cast<std::int64_t>(messages.size());
  }));
  const std::string log = daemon.log_text();
  const std::string line = "warning malformed message channel=CAMWAY_PLAN_REQUEST";
  EXPECT_NE(log.find(line), std::string::npos);
  EXPECT_EQ(log.find(line), log.rfind(line)) << "only the first of a burst is logged\n" << log;
}

TEST(Service, AnswersOnlySoManyMessagesThatCannotBeRead) {
  ServiceConfig config = quick_heartbeats();
  config.malformed_answers_per_s = 5.0;
  RunningService daemon(config);
  for (int i = 0; i < 1000; ++i) daemon.send_on(daemon.channels.plan_request(), Bytes(7, 0));
  EXPECT_TRUE(status_with(
      daemon, [](const status_t& status) { return status.malformed_messages == 1000; }));
  daemon.stop();
  EXPECT_LE(daemon.transport.published_on(daemon.channels.error()).size(), 500U)
      << "5 at once, then 5 a second";
}

TEST(Service, LivesThroughAFloodOfMutants) {
  RunningService daemon;
  Random random(kSeed);
  const Bytes plan = wire::encode(request_with(5));
  const Bytes batch = wire::encode(testing::random_message<occupancy_request_t>(random));
  for (int i = 0; i < 3000; ++i) {
    Bytes bytes = i % 2 == 0 ? plan : batch;
    mutate(bytes, random);
    daemon.send_on(
        i % 2 == 0 ? daemon.channels.plan_request() : daemon.channels.occupancy_request(),
        std::move(bytes));
  }
  plan_request_t last = request_with(1'000'000);
  last.client_id = "survivor";
  // The flood may fill the queue of jobs; then the client sends again.
  for (std::size_t tries = 0;; ++tries) {
    ASSERT_LT(tries, 1000U);
    daemon.send(last);
    const std::optional<plan_response_t> answer = daemon.answer_to(last, tries);
    ASSERT_TRUE(answer);
    if (answer->status == plan_response_t::STATUS_OK) break;
    ASSERT_EQ(answer->status, plan_response_t::STATUS_OVERLOADED);
  }
}

TEST(Service, CountsWhatItDoes) {
  ServiceConfig config = quick_heartbeats();
  config.queue.jobs = 1;
  RunningService daemon(config);
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send(request_with(2));
  daemon.send(request_with(3));
  EXPECT_TRUE(status_with(daemon, [](const status_t& status) {
    return status.running_requests == 1 && status.queued_requests == 1 &&
           status.overloaded_requests == 1 && status.answered_requests == 1;
  }));
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request_with(2)));
  daemon.send(request_with(1));
  EXPECT_TRUE(status_with(daemon, [](const status_t& status) {
    return status.running_requests == 0 && status.queued_requests == 0 &&
           status.answered_requests == 4 && status.repeated_requests == 1;
  }));
}

TEST(Service, StatusStaysWithinAMessageHoweverManyScenes) {
  RunningService daemon(quick_heartbeats());
  for (int i = 1000; i < 2000; ++i) {
    daemon.scenes.put(testing::empty_scene(std::string(100, 'n') + std::to_string(i)));
  }
  const std::optional<status_t> status =
      status_with(daemon, [](const status_t& s) { return s.total_scenes == 1002; });
  ASSERT_TRUE(status);
  EXPECT_LT(status->num_scenes, 1002);
  const std::size_t size = wire::encode(*status).size();
  EXPECT_LE(size, wire::kMaxMessageBytes);
  EXPECT_GT(size, wire::kMaxMessageBytes - 400) << "one more scene would have fitted";
  EXPECT_TRUE(std::is_sorted(status->scenes.begin(), status->scenes.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST(Service, StopFinishesWhatIsBeingPlannedAndRefusesTheRest) {
  RunningService daemon;
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send(request_with(2));
  // This request is answered at once. When its answer comes, the second one has been queued.
  plan_request_t marker = request_with(3);
  marker.scene = "cellar";
  daemon.send(marker);
  ASSERT_TRUE(daemon.answer_to(marker));

  RunOutcome outcome{};
  std::thread stopper([&] { outcome = daemon.stop(); });
  const std::optional<plan_response_t> refused = daemon.answer_to(request_with(2));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, plan_response_t::STATUS_OVERLOADED);
  EXPECT_EQ(refused->message, "the daemon is stopping");
  daemon.send(request_with(4));
  EXPECT_EQ(daemon.answer_to(request_with(4))->status, plan_response_t::STATUS_OVERLOADED);
  daemon.planner.release();
  stopper.join();
  EXPECT_EQ(outcome, RunOutcome::kDrained);
  EXPECT_EQ(daemon.answer_to(request_with(1))->status, plan_response_t::STATUS_OK);
  EXPECT_EQ(daemon.planner.calls(), 1);
}

// A worker counts as idle only shortly after it woke the loop with its answer. A stop that checked
// in between and then waited for another wake would use up its time limit.
TEST(Service, StopEndsAsSoonAsTheLastAnswerIsOut) {
  for (int round = 0; round < 200; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    RunningService daemon;
    daemon.planner.hold();
    daemon.send(request_with(1));
    ASSERT_TRUE(daemon.planner.wait_for_calls(1));
    std::thread releaser([&] { daemon.planner.release(); });
    EXPECT_EQ(daemon.stop(), RunOutcome::kDrained);
    releaser.join();
    ASSERT_LT(std::chrono::steady_clock::now() - begin, ServiceConfig{}.drain_limit)
        << "in round " << round;
  }
}

TEST(Service, StopWaitsNoLongerThanItsLimit) {
  ServiceConfig config;
  config.drain_limit = std::chrono::milliseconds(30);
  RunningService daemon(config);
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  EXPECT_EQ(daemon.stop(), RunOutcome::kAbandoned);
}

TEST(Service, StopSendsEveryPageOfALongAnswer) {
  RunningService daemon;
  const plan_request_t request = request_with(1, 5000);
  daemon.planner.hold();
  daemon.send(request);
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  RunOutcome outcome{};
  std::thread stopper([&] { outcome = daemon.stop(); });
  daemon.planner.release();
  stopper.join();
  EXPECT_EQ(outcome, RunOutcome::kDrained);
  EXPECT_EQ(daemon.answer_to(request)->num_segments, 5000);
}

TEST(Service, SaysWhenTheTransportFails) {
  RunningService daemon;
  ASSERT_TRUE(daemon.transport.wait_for_messages_on(daemon.channels.status(), 1));
  daemon.transport.break_down();
  EXPECT_EQ(daemon.wait_for_end(), RunOutcome::kTransportBroken);
}

/// An answerer that plans elsewhere, in a later revision that this process does not hold.
class AheadAnswerer final : public PlanAnswerer {
 public:
  Answered answer(const std::shared_ptr<const scene::Snapshot>&, const plan_request_t& request,
                  const base::Deadline&) override {
    messages::AnswerHeader header;
    header.ids = {request.client_id, request.request_id, utime_now()};
    header.scene = request.scene;
    header.scene_revision = 99;
    Answered answered{messages::plain_answer(plan_response_t::STATUS_OK, "elsewhere", header)};
    if (request.watch_lease_s > 0.0) {
      answered.path = std::make_shared<const planning::WatchedPath>(
          testing::echo_result(*messages::from_wire(request)).path, motion::Body(motion::Camera{}),
          collision::DetectOptions{});
    }
    return answered;
  }
};

TEST(Service, AnswersOfOtherProcessesMayBeOfALaterRevision) {
  RunningService daemon({}, std::make_shared<AheadAnswerer>());
  plan_request_t request = request_with(1);
  request.watch_lease_s = 30.0;
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->message, "elsewhere");
  EXPECT_EQ(answer->scene_revision, 99);
  const auto report =
      daemon.transport.message_on(daemon.channels.watch_report(request.client_id), 0);
  ASSERT_TRUE(report) << "its path is watched, and checked in the scene that is here";
  const auto decoded = wire::decode<watch_report_t>(*report);
  ASSERT_TRUE(decoded.message);
  ASSERT_EQ(decoded.message->paths.size(), 1U);
  EXPECT_EQ(decoded.message->paths[0].answer_revision, 99);
  EXPECT_EQ(decoded.message->paths[0].state, path_state_t::FREE);
}

TEST(Service, AllowsAsManyPlansAsItIsTold) {
  ServiceConfig config = testing::with_workers(1, 64);
  config.most_jobs = 3;
  RunningService daemon(config);
  daemon.planner.hold();
  for (int id = 1; id <= 5; ++id) daemon.send(request_with(id));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(daemon.planner.calls(), 1) << "its own workers, until it hears of planners";
  daemon.service().allow(3);
  ASSERT_TRUE(daemon.planner.wait_for_calls(3));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(daemon.planner.calls(), 3);
  daemon.planner.release();
  for (int id = 1; id <= 5; ++id) ASSERT_TRUE(daemon.answer_to(request_with(id)));
}

TEST(Service, SaysWhenNothingCanBeSubscribed) {
  testing::FakeTransport transport;
  transport.fail_subscribe();
  scene::SceneStore scenes;
  const testing::CapturedLog log;
  Service service(
      transport, scenes, {},
      [](const scene::Snapshot&, const planning::PlanRequest&, const base::Deadline&) {
        return planning::PlanResult{};
      },
      log.log());
  EXPECT_EQ(service.run(), RunOutcome::kNotSubscribed);
  EXPECT_TRUE(transport.published().empty());
}

}  // namespace
}  // namespace camway::service
