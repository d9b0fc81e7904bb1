// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <camway/plan_progress_t.hpp>

#include "lcmtypes/wire/layout.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::Bytes;
using testing_support::ClientTest;
using testing_support::encode_all;
using testing_support::FakeDaemon;
using testing_support::quick;
using testing_support::small_request;

TEST_F(ClientTest, PlansAndEvaluatesThePath) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& request) {
    return encode_all(answer_pages(request, 2, 10));
  };
  daemon.start();
  Client client(quick());
  PlanRequest request = small_request();
  request.method = "keyframe_insertion";
  request.keyframes[0].time_s = 0.0;
  request.keyframes[1] = {4.5, {1, 2, 3}, {0, 1, 0, 0}};
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.error, "");
  EXPECT_EQ(response.tries, 1);
  EXPECT_GT(response.elapsed_s, 0.0);
  EXPECT_EQ(response.path.end(), 2.0);
  EXPECT_DOUBLE_EQ(response.path.pose(1.5).position_m[0], 1.5);

  daemon.stop();
  ASSERT_EQ(daemon.plan_requests().size(), 1u);
  const plan_request_t& sent = daemon.plan_requests()[0];
  EXPECT_EQ(sent.client_id, client.client_id());
  EXPECT_EQ(sent.request_id, response.request_id);
  EXPECT_EQ(sent.method, "keyframe_insertion");
  EXPECT_TRUE(sent.has_times);
  EXPECT_EQ(sent.keyframes[1].time_s, 4.5);
  EXPECT_EQ(sent.keyframes[1].position_m[2], 3.0);
  EXPECT_EQ(sent.keyframes[1].orientation_wxyz[1], 1.0);
}

TEST_F(ClientTest, SaysThatThereIsNoDaemon) {
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  EXPECT_EQ(response.status, Status::kNoDaemon);
  EXPECT_EQ(response.tries, 1 + quick().retries);
  EXPECT_THAT(response.error, HasSubstr("start camwayd"));
  EXPECT_EQ(client.occupancy({}).status, Status::kNoDaemon);
  EXPECT_EQ(client.status(0.05).status, Status::kNoDaemon);
}

TEST_F(ClientTest, WaitsForADaemonThatLivesButEndsAtTheDeadline) {
  FakeDaemon daemon;
  daemon.heartbeat_every = milliseconds(5);
  daemon.start();
  ClientOptions options = quick();
  options.deadline_s = 1.5;  // more than (1 + retries) tries
  Client client(options);
  const PlanResponse response = client.plan(small_request());
  EXPECT_EQ(response.status, Status::kNoAnswer);
  EXPECT_THAT(response.error, HasSubstr("did not answer by the deadline"));
  EXPECT_GE(response.elapsed_s, 1.5);
  EXPECT_GT(response.tries, 1 + options.retries);
}

TEST_F(ClientTest, WaitsForNoDaemonThatDropsWhatIsNotSigned) {
  status_t status{};
  status.uptime_s = 10.0;
  status.signed_only = 1;
  FakeDaemon daemon;
  daemon.raw_heartbeat = wire::encode(status);
  daemon.heartbeat_every = milliseconds(30);
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  EXPECT_EQ(response.status, Status::kNoAnswer);
  EXPECT_THAT(response.error, HasSubstr("drops what is not signed"));
  EXPECT_LT(response.elapsed_s, quick().deadline_s);
  EXPECT_THAT(client.list_scenes().error, HasSubstr("drops what is not signed"));
  EXPECT_TRUE(client.status().signed_only) << "a heartbeat is read all the same";
}

TEST_F(ClientTest, RepeatsTheSameRequestUntilItIsAnswered) {
  int calls = 0;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    return ++calls < 3 ? std::vector<Bytes>{} : encode_all(answer_pages(request, 1, 1));
  };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.tries, 3);
  daemon.stop();
  std::set<std::int64_t> ids;
  for (const plan_request_t& request : daemon.plan_requests()) ids.insert(request.request_id);
  EXPECT_EQ(ids.size(), 1u);
}

TEST_F(ClientTest, SendsAgainAtOnceWhenTheDaemonWasRestarted) {
  ClientOptions options = quick();
  options.try_timeout_s = options.max_try_timeout_s = 15.0;
  Client client(options);
  int calls = 0;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    // The first request is lost with the daemon that took it.
    return ++calls == 1 ? std::vector<Bytes>{} : encode_all(answer_pages(request, 1, 1));
  };
  daemon.heartbeat_every = milliseconds(50);
  daemon.uptime_s = 0.0;
  daemon.start();
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_LT(response.elapsed_s, options.try_timeout_s);
}

TEST_F(ClientTest, WaitsWhileTheDaemonIsOverloaded) {
  int calls = 0;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    auto pages = answer_pages(request, 1, 1);
    if (++calls <= 6) {
      pages[0].status = plan_response_t::STATUS_OVERLOADED;
      pages[0].message = "queue full";
    }
    return encode_all(pages);
  };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.tries, 7);

  calls = -1000;
  ClientOptions options = quick();
  options.deadline_s = 0.5;
  const PlanResponse refused = Client(options).plan(small_request());
  EXPECT_EQ(refused.status, Status::kOverloaded);
  EXPECT_THAT(refused.error, HasSubstr("queue full"));
}

TEST_F(ClientTest, PassesOnWhatTheDaemonSays) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& request) {
    auto pages = answer_pages(request, 1, 1);
    pages[0].status = static_cast<std::int32_t>(request.deadline_s);
    pages[0].message = "because";
    pages[0].keyframe = 4;
    return encode_all(pages);
  };
  daemon.start();
  Client client(quick());
  for (const Status status :
       {Status::kPartial, Status::kInfeasible, Status::kTimeout, Status::kInvalid,
        Status::kUnknownScene, Status::kInternalError, Status::kMalformed}) {
    PlanRequest request = small_request();
    request.deadline_s = static_cast<double>(status);
    const PlanResponse response = client.plan(request);
    EXPECT_EQ(response.status, status) << response.error;
    EXPECT_FALSE(response.ok());
    EXPECT_EQ(response.keyframe, 4);
    EXPECT_THAT(response.error, HasSubstr("because"));
  }
}

TEST_F(ClientTest, SurvivesAHostilePeer) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& request) {
    const Bytes good = encode_all(answer_pages(request, 3, 3))[0];
    Bytes huge = good;
    // The count of segments, which is directly before the first one: 2^31 - 1. Behind the segments
    // are the counts of the eight other lists, which are empty.
    const std::size_t count_at = good.size() - 3 * 42 * 8 - 8 * 4 - 4;
    huge[count_at] = 0x7f;
    huge[count_at + 1] = huge[count_at + 2] = huge[count_at + 3] = 0xff;
    const Bytes cut(good.begin(), good.begin() + 70);
    return std::vector<Bytes>{{}, cut, huge, good};
  };
  daemon.raw_heartbeat = Bytes(9, 0xff);
  daemon.heartbeat_every = milliseconds(5);
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.tries, 1);
}

TEST_F(ClientTest, SaysThatAnAnswerCannotBeRead) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t&) { return std::vector<Bytes>{Bytes(20, 1)}; };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  EXPECT_EQ(response.status, Status::kBadAnswer);
  EXPECT_THAT(response.error, HasSubstr("fingerprint"));
}

TEST_F(ClientTest, ManyThreadsMayUseAClientAtATime) {
  FakeDaemon daemon;
  daemon.heartbeat_every = milliseconds(20);
  daemon.on_plan = [](const plan_request_t& request) {
    return encode_all(answer_pages(request, static_cast<int>(request.deadline_s), 2));
  };
  daemon.start();
  Client client(quick());
  std::vector<std::thread> threads;
  for (int i = 1; i <= 8; ++i) {
    threads.emplace_back([&client, i] {
      PlanRequest request = small_request();
      request.deadline_s = i;
      const PlanResponse response = client.plan(request);
      EXPECT_TRUE(response.ok()) << response.error;
      EXPECT_EQ(response.path.segments().size(), std::size_t(i));
      EXPECT_TRUE(client.status().ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST_F(ClientTest, ManyRequestsAreOnTheirWayAtATime) {
  constexpr int kRequests = 20;
  std::map<std::int64_t, plan_request_t> waiting;
  FakeDaemon daemon;
  daemon.heartbeat_every = milliseconds(20);  // alive, but
  // answers when all are there, the last first.
  daemon.on_plan = [&](const plan_request_t& request) {
    waiting[request.request_id] = request;
    std::vector<Bytes> answers;
    if (waiting.size() < kRequests) return answers;
    for (auto next = waiting.rbegin(); next != waiting.rend(); ++next) {
      const int segments = static_cast<int>(next->second.seed);
      answers.push_back(encode_all(answer_pages(next->second, segments, 100))[0]);
    }
    return answers;
  };
  daemon.start();
  std::atomic<int> handled = 0;
  Client client(quick());
  std::vector<PendingPlan> pending;
  for (int i = 1; i <= kRequests; ++i) {
    PlanRequest request = small_request();
    request.seed = i;
    PlanHandlers handlers;
    handlers.on_answer = [&handled, i](const PlanResponse& response) {
      EXPECT_EQ(response.path.segments().size(), std::size_t(i));
      ++handled;
    };
    pending.push_back(client.plan_async(request, std::move(handlers)));
  }
  std::set<std::int64_t> ids;
  for (int i = 1; i <= kRequests; ++i) {
    PendingPlan& plan = pending[std::size_t(i - 1)];
    const PlanResponse response = plan.answer.get();
    ASSERT_TRUE(response.ok()) << response.error;
    EXPECT_EQ(response.path.segments().size(), std::size_t(i));
    EXPECT_EQ(response.request_id, plan.request_id);
    ids.insert(plan.request_id);
  }
  EXPECT_EQ(ids.size(), std::size_t(kRequests));
  EXPECT_EQ(handled, kRequests);
}

TEST_F(ClientTest, CallsARequestOffUntilTheDaemonSaysSo) {
  int cancels = 0;
  std::atomic<bool> is_asked = false;
  plan_request_t asked{};
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    asked = request;
    is_asked = true;
    return std::vector<Bytes>{};
  };
  daemon.on_cancel = [&](const cancel_t& cancel) {
    if (++cancels < 3 || cancel.request_id != asked.request_id) return std::vector<Bytes>{};
    auto pages = answer_pages(asked, 0, 1);
    pages[0].status = plan_response_t::STATUS_CANCELLED;
    pages[0].message = "cancelled by its client";
    return encode_all(pages);
  };
  daemon.start();
  Client client(quick());
  PendingPlan plan = client.plan_async(small_request());
  while (!is_asked) std::this_thread::yield();
  client.cancel(plan.request_id);
  client.cancel(plan.request_id + 1);  // none of ours
  const PlanResponse response = plan.answer.get();
  EXPECT_EQ(response.status, Status::kCancelled);
  EXPECT_THAT(response.error, HasSubstr("cancelled"));
  client.cancel(plan.request_id);  // once more does no harm
  daemon.stop();
  EXPECT_EQ(cancels, 3);
}

TEST_F(ClientTest, HearsHowFarTheDaemonIs) {
  FakeDaemon daemon;
  double period_s = 0.0;
  daemon.on_plan = [&](const plan_request_t& request) {
    period_s = request.progress_period_s;
    plan_progress_t progress{};
    progress.client_id = request.client_id;
    progress.request_id = request.request_id;
    progress.stage = plan_progress_t::CORRECTING;
    progress.num_collisions = 4;
    progress.num_corrected = 3;
    daemon.publish("CAMWAY_PLAN_PROGRESS_" + request.client_id, wire::encode(progress));
    return encode_all(answer_pages(request, 1, 1));
  };
  daemon.start();
  Client client(quick());
  std::vector<PlanProgress> told;
  PlanHandlers handlers;
  handlers.on_progress = [&](const PlanProgress& progress) {
    told.push_back(progress);
    throw 1;  // the user's mistake, not the client's end
  };
  ASSERT_TRUE(client.plan_async(small_request(), handlers).answer.get().ok());
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].stage, PlanProgress::Stage::kCorrecting);
  EXPECT_EQ(told[0].num_collisions, 4);
  EXPECT_EQ(told[0].num_corrected, 3);
  daemon.stop();
  EXPECT_GT(period_s, 0.0) << "who has a handler wants to know";
}

TEST_F(ClientTest, AHandlerIsNotAllowedToWaitForItsClient) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& request) {
    return encode_all(answer_pages(request, 1, 1));
  };
  daemon.start();
  Client client(quick());
  Status status = Status::kOk;
  PendingPlan next;
  PlanHandlers handlers;
  handlers.on_answer = [&](const PlanResponse&) {
    status = client.plan(small_request()).status;
    next = client.plan_async(small_request());
  };
  ASSERT_TRUE(client.plan_async(small_request(), handlers).answer.get().ok());
  EXPECT_EQ(status, Status::kBusy);
  EXPECT_TRUE(next.answer.get().ok()) << "but he may ask without waiting";
}

TEST_F(ClientTest, RequestsEndWithTheirClient) {
  PendingPlan plan;
  {
    Client client(quick());
    plan = client.plan_async(small_request());
  }
  const PlanResponse response = plan.answer.get();
  EXPECT_EQ(response.status, Status::kNoAnswer);
  EXPECT_THAT(response.error, HasSubstr("the client was destroyed"));
}

TEST_F(ClientTest, MayBeDestroyedByItsOwnHandlers) {
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) -> std::vector<Bytes> {
    if (request.scene == "nowhere") {
      plan_progress_t progress{};
      progress.client_id = request.client_id;
      progress.request_id = request.request_id;
      daemon.publish(wire::Channels{}.plan_progress(request.client_id), wire::encode(progress));
      return {};
    }
    return encode_all(answer_pages(request, 1, 1));
  };
  daemon.start();
  enum class By { kAnswer, kProgress, kWatch, kUnwatching };
  for (const By by : {By::kAnswer, By::kProgress, By::kWatch, By::kUnwatching}) {
    auto client = std::make_unique<Client>(quick());
    std::atomic<int> ended = 0;
    std::promise<int> ended_when_destroyed;
    std::promise<void> all_sent;
    const auto destroy = [&, sent = all_sent.get_future().share()] {
      sent.wait();  // for no thread may be in one of its members
      if (!client) return;
      client.reset();
      ended_when_destroyed.set_value(ended);
    };
    PlanRequest unanswered = small_request();
    unanswered.scene = "nowhere";
    std::vector<PendingPlan> pending;
    for (int i = 0; i < 3; ++i) {
      PlanHandlers handlers;
      handlers.on_answer = [&](const PlanResponse&) { ++ended; };
      if (by == By::kProgress) handlers.on_progress = [&](const PlanProgress&) { destroy(); };
      pending.push_back(client->plan_async(unanswered, handlers));
    }
    if (by == By::kAnswer) {
      client->plan_async(small_request(), {{}, [&](const PlanResponse&) { destroy(); }});
    } else if (by == By::kWatch) {
      client->watch(small_request(), [&](const WatchEvent&) { destroy(); });
    } else if (by == By::kUnwatching) {
      client->watch(
          small_request(), [&, captured = std::string(100, 'x')](const WatchEvent& event) {
            if (!client) return;
            client->unwatch(event.request_id);
            destroy();
            EXPECT_EQ(captured, std::string(100, 'x')) << "the handler outlives the client";
          });
    }
    all_sent.set_value();
    EXPECT_EQ(ended_when_destroyed.get_future().get(), 3) << "no handler is called afterwards";
    for (PendingPlan& plan : pending) EXPECT_FALSE(plan.answer.get().ok());
  }
}

TEST_F(ClientTest, ReportsTheHeartbeat) {
  FakeDaemon daemon;
  daemon.heartbeat_every = milliseconds(20);
  daemon.start();
  Client client(quick());
  const DaemonStatus status = client.status();
  ASSERT_TRUE(status.ok()) << status.error;
  EXPECT_EQ(status.version, "fake");
  EXPECT_EQ(status.uptime_s, 1000.0);
}

TEST(ClientOptionsTest, WrongOnesAreNamed) {
  const auto error_of = [](auto change) {
    ClientOptions options;
    change(options);
    Client client(options);
    EXPECT_EQ(client.plan({}).status, Status::kInvalid);
    return client.error();
  };
  EXPECT_THAT(error_of([](auto& o) { o.prefix = "A B"; }), HasSubstr("prefix: \"A B\""));
  EXPECT_THAT(error_of([](auto& o) { o.prefix = "TWELVE_CHARS"; }), HasSubstr("prefix"));
  EXPECT_THAT(error_of([](auto& o) { o.client_id = ".*"; }), HasSubstr("client_id: \".*\""));
  EXPECT_THAT(error_of([](auto& o) { o.deadline_s = 0; }), HasSubstr("deadline_s"));
  EXPECT_THAT(error_of([](auto& o) { o.try_timeout_s = -1; }), HasSubstr("try_timeout_s"));
  EXPECT_THAT(error_of([](auto& o) { o.backoff = 0.5; }), HasSubstr("backoff"));
  EXPECT_THAT(error_of([](auto& o) { o.retries = -1; }), HasSubstr("retries"));
  EXPECT_THAT(error_of([](auto& o) { o.jitter = 1.0; }), HasSubstr("jitter"));
}

// As those that run later, on the client's own thread.
TEST(ClientOptionsTest, HandlersOfWhatCannotBeSentMayThrow) {
  ClientOptions options;
  options.prefix = "A B";
  Client client(options);
  int answers = 0;
  PlanHandlers handlers;
  handlers.on_answer = [&](const PlanResponse&) {
    ++answers;
    throw std::runtime_error("of the user");
  };
  EXPECT_EQ(client.plan_async({}, handlers).answer.get().status, Status::kInvalid);
  EXPECT_EQ(answers, 1);
  WatchEvent last;
  const std::int64_t id = client.watch({}, [&](const WatchEvent& event) {
    last = event;
    throw std::runtime_error("of the user");
  });
  EXPECT_EQ(id, 0);
  EXPECT_EQ(last.kind, WatchEvent::Kind::kEnded);
  EXPECT_EQ(last.status, Status::kInvalid);
  EXPECT_THAT(last.error, HasSubstr("prefix"));
}

TEST(ClientOptionsTest, AnUnusableNetworkIsAnError) {
  ClientOptions options;
  options.url = "no-such-provider://";
  Client client(options);
  EXPECT_FALSE(client.good());
  const PlanResponse response = client.plan({});
  EXPECT_EQ(response.status, Status::kNetworkUnusable);
  EXPECT_THAT(response.error, HasSubstr("no-such-provider"));
  EXPECT_THAT(response.error, HasSubstr("multicast"));
}

TEST(ClientIds, DifferFromClientToClient) { EXPECT_NE(Client().client_id(), Client().client_id()); }

}  // namespace
}  // namespace camway
