// SPDX-License-Identifier: MIT
#include "daemon/service/plans/plan_service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <thread>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/plan_progress_t.hpp>

#include "daemon/messages/plan.h"
#include "daemon/planning/request/validate.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using testing::echo_result;
using testing::request_of;
using testing::request_with;
using testing::RunningService;
using testing::with_workers;

/// Returns the answer without the members that may differ between two runs.
Bytes without_time(plan_response_t answer) {
  answer.utime = 0;
  answer.daemon_start = {};
  return wire::encode(answer);
}

/// Returns the expected answer to `request` if `planner` is the echo.
Bytes expected_echo(const plan_request_t& request, const messages::DeadlineLimits& limits = {}) {
  return without_time(messages::to_wire(echo_result(*messages::from_wire(request, limits)),
                                        {{request.client_id, request.request_id, 0},
                                         request.scene,
                                         7,
                                         "0123456789abcdef0123456789abcdef"}));
}

TEST(PlanService, AnswersARequestOnItsClientsChannel) {
  RunningService daemon;
  const plan_request_t request = request_with(1);
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_GT(answer->utime, 1'600'000'000'000'000) << "microseconds since 1970";
  EXPECT_EQ(without_time(*answer), expected_echo(request));
  EXPECT_NE(daemon.log_text().find("answered client=tester request=1 scene=room status=ok"),
            std::string::npos)
      << daemon.log_text();
}

TEST(PlanService, SaysBehindTheMessageWhatTheImportLeftOut) {
  RunningService daemon;
  auto scene = std::make_shared<scene::Snapshot>(*daemon.scenes.find("room"));
  scene->report.dropped_nonfinite = 3;
  daemon.scenes.put(scene);
  const plan_request_t request = request_with(1);
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->message, echo_result(*messages::from_wire(request)).message +
                                 "; warning: the scene is without faces of its file: 3 with a "
                                 "coordinate that is no usable number");
}

TEST(PlanService, LongRequestsAndAnswersTravelInPages) {
  RunningService daemon;
  const plan_request_t request = request_with(1, 3000);
  std::vector<Bytes> pages = wire::encode_pages(request);
  ASSERT_GT(pages.size(), 3U);
  std::reverse(pages.begin(), pages.end());
  for (Bytes& page : pages) daemon.send_on(daemon.channels.plan_request(), std::move(page));
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(without_time(*answer), expected_echo(request));
  for (const auto& message : daemon.transport.published()) {
    EXPECT_LE(message.bytes.size(), wire::kMaxMessageBytes);
  }
}

TEST(PlanService, ARepeatedRequestGetsTheSameBytesWithoutPlanning) {
  RunningService daemon;
  plan_request_t request = request_with(1, 1500);
  daemon.send(request);
  ASSERT_TRUE(daemon.answer_to(request));
  const std::string channel = daemon.channels.plan_response("tester");
  const std::vector<Bytes> first = daemon.transport.published_on(channel);
  ASSERT_GT(first.size(), 2U);
  request.utime = 99;  // a client that sends again may say when
  daemon.send(request);
  ASSERT_TRUE(daemon.answer_to(request, first.size()));
  const std::vector<Bytes> both = daemon.transport.published_on(channel);
  ASSERT_EQ(both.size(), 2 * first.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(),
                         both.begin() + static_cast<std::ptrdiff_t>(first.size())));
  EXPECT_EQ(daemon.planner.calls(), 1);
}

TEST(PlanService, ARequestThatIsBeingPlannedIsNotPlannedTwice) {
  RunningService daemon(with_workers(2, 8));
  daemon.planner.hold();
  const plan_request_t request = request_with(1);
  daemon.send(request);
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  for (int i = 0; i < 5; ++i) daemon.send(request);
  // Requests are handled in order, so once this one is planned, the five before have been handled.
  const plan_request_t next = request_with(2);
  daemon.send(next);
  ASSERT_TRUE(daemon.planner.wait_for_calls(2));
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request));
  ASSERT_TRUE(daemon.answer_to(next));
  EXPECT_EQ(daemon.stop(), RunOutcome::kDrained);
  EXPECT_EQ(daemon.planner.calls(), 2);
  EXPECT_EQ(daemon.transport.published_on(daemon.channels.plan_response("tester")).size(), 2U);
}

TEST(PlanService, TheSameIdForAnotherRequestIsAnError) {
  RunningService daemon;
  plan_request_t request = request_with(1);
  daemon.send(request);
  ASSERT_TRUE(daemon.answer_to(request));
  plan_request_t other = request;
  other.camera.near_m *= 2;
  daemon.send(other);
  const std::optional<plan_response_t> answer = daemon.answer_to(other, 1);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_INVALID);
  EXPECT_EQ(answer->message, "request_id: 1 was used before for another request");
  EXPECT_EQ(daemon.planner.calls(), 1);
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request, 2)->status, plan_response_t::STATUS_OK)
      << "the first request keeps its answer";
}

TEST(PlanService, SaysWhichScenesThereAre) {
  RunningService daemon;
  plan_request_t request = request_with(1);
  request.scene = "cellar";
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_EQ(answer->message, "scene: 'cellar' is unknown; there are: 'hall' 'room'");
  EXPECT_EQ(answer->scene, "cellar");
  EXPECT_EQ(answer->scene_revision, 0);
}

TEST(PlanService, KeepsControlCharactersOfAPeerOutOfAnswersAndLogs) {
  RunningService daemon;
  plan_request_t request = request_with(2);
  request.scene = "off\nice\x1b[31m";
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->scene, "off?ice?[31m");
  EXPECT_EQ(answer->message.find_first_of("\n\x1b"), std::string::npos);
}

TEST(PlanService, PassesOnWhatPlanningFoundInvalid) {
  RunningService daemon({}, [](const planning::PlanRequest& request) {
    planning::PlanResult result;
    const std::optional<planning::InvalidRequest> fault = planning::validate(request);
    result.status = fault ? planning::Status::kInvalid : planning::Status::kOk;
    if (fault) {
      result.message = fault->message;
      result.keyframe = fault->keyframe;
    }
    return result;
  });
  plan_request_t request = request_with(1);
  std::fill_n(request.keyframes[2].orientation_wxyz, 4, 0.0);
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_INVALID);
  EXPECT_EQ(answer->keyframe, 2);
  EXPECT_NE(answer->message.find("keyframes[2].orientation"), std::string::npos);

  plan_request_t unknown_method = request_with(2);
  unknown_method.method = "magic";
  daemon.send(unknown_method);
  EXPECT_EQ(daemon.answer_to(unknown_method)->message,
            "method: 'magic' is unknown; the values are ladder, keyframe_insertion");

  plan_request_t negative = request_with(3);
  negative.clearance_m = -1.0;
  daemon.send(negative);
  EXPECT_EQ(daemon.answer_to(negative)->message.find("clearance_m: is -1"), 0U)
      << "the wire has no group of options, and its own names: "
      << daemon.answer_to(negative)->message;
}

TEST(PlanService, RefusesWhatMakesNoSenseOfItsHandling) {
  RunningService daemon;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::function<void(plan_request_t&)>, std::string>> table{
      {[](auto& r) { r.priority = 100; }, "priority: is 100; it must be -1 (low), 0 or 1 (high)"},
      {[](auto& r) { r.priority = -2; }, "priority: is -2"},
      {[](auto& r) { r.deadline_s = -1.0; }, "deadline_s: is -1; it must be at least 0"},
      {[](auto& r) { r.deadline_s = kNan; }, "deadline_s: is nan"},
      {[](auto& r) { r.progress_period_s = -0.1; }, "progress_period_s: is -0.1"},
      {[](auto& r) { r.progress_period_s = kNan; }, "progress_period_s: is nan"},
      {[](auto& r) { r.watch_lease_s = kNan; }, "watch_lease_s: is nan"},
  };
  std::int64_t id = 0;
  for (const auto& [change, fault] : table) {
    plan_request_t request = request_with(++id);
    change(request);
    daemon.send(request);
    const std::optional<plan_response_t> answer = daemon.answer_to(request);
    ASSERT_TRUE(answer) << fault;
    EXPECT_EQ(answer->status, plan_response_t::STATUS_INVALID) << fault;
    EXPECT_EQ(answer->message.find(fault), 0U) << answer->message;
  }
  EXPECT_EQ(daemon.planner.calls(), 0);
}

TEST(PlanService, APlannerThatThrowsIsAnInternalError) {
  RunningService daemon({}, [](const planning::PlanRequest& request) {
    if (request.keyframes.size() == 3) throw std::runtime_error("out of luck");
    return echo_result(request);
  });
  daemon.send(request_with(1, 3));
  const std::optional<plan_response_t> answer = daemon.answer_to(request_with(1, 3));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_INTERNAL_ERROR);
  EXPECT_EQ(answer->message, "internal error: out of luck");
  daemon.send(request_with(2, 4));
  EXPECT_EQ(daemon.answer_to(request_with(2, 4))->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, AnAnswerBeyondAllPagesIsAnErrorThatSaysSo) {
  // One segment more than all pages can hold, since sanitizers are slow with many.
  const auto size = static_cast<std::size_t>(collision_interval_t{}._getEncodedSizeNoHash());
  const std::size_t count = wire::kMaxResponsePages * wire::kMaxMessageBytes / size + 1;
  RunningService daemon({}, [count](const planning::PlanRequest&) {
    planning::PlanResult result;
    result.collisions.resize(count);
    return result;
  });
  daemon.send(request_with(1));
  const std::optional<plan_response_t> answer = daemon.answer_to(request_with(1));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_LIMIT);
  EXPECT_NE(answer->message.find("more than the 1024 allowed"), std::string::npos);
}

TEST(PlanService, DeadlinesAreLimitedByTheConfiguration) {
  ServiceConfig config;
  config.deadline = {.default_s = 0.5, .max_s = 2.0};
  RunningService daemon(config, [](const planning::PlanRequest& request) {
    planning::PlanResult result = echo_result(request);
    result.message = std::to_string(request.options.deadline_s);
    return result;
  });
  plan_request_t request = request_with(1);
  request.deadline_s = 100.0;
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request)->message, std::to_string(2.0));
  request.request_id = 2;
  request.deadline_s = 0.0;
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request)->message, std::to_string(0.5));
}

TEST(PlanService, DeadlinesRunFromReceipt) {
  RunningService daemon;
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  plan_request_t waiting = request_with(2);
  waiting.deadline_s = 30.0;
  daemon.send(waiting);
  plan_request_t marker = request_with(3);
  marker.scene = "cellar";  // answered at once, so the one before is in the queue then
  daemon.send(marker);
  ASSERT_TRUE(daemon.answer_to(marker));
  constexpr double kWait_s = 0.2;
  std::this_thread::sleep_for(std::chrono::duration<double>(kWait_s));
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(waiting));
  EXPECT_LE(daemon.planner.last_budget_s(), waiting.deadline_s - kWait_s);
}

TEST(PlanService, ARequestThatWaitedPastItsDeadlineIsAnsweredThen) {
  RunningService daemon;
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  plan_request_t late = request_with(2);
  late.deadline_s = 0.05;
  daemon.send(late);
  // The worker is still busy with the first request.
  const std::optional<plan_response_t> answer = daemon.answer_to(late);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_TIMEOUT);
  EXPECT_NE(answer->message.find("the deadline of 0.05 s passed"), std::string::npos)
      << answer->message;
  EXPECT_EQ(answer->scene_revision, 7);
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request_with(1)));
  EXPECT_EQ(daemon.planner.calls(), 1);
}

cancel_t cancel_of(const plan_request_t& request) {
  cancel_t cancel{};
  cancel.client_id = request.client_id;
  cancel.request_id = request.request_id;
  return cancel;
}

void send_cancel(RunningService& daemon, const plan_request_t& request) {
  daemon.send_on(daemon.channels.cancel(), wire::encode(cancel_of(request)));
}

TEST(PlanService, ARequestThatIsBeingPlannedIsCancelled) {
  RunningService daemon;
  daemon.planner.hold();
  const plan_request_t request = request_with(1);
  daemon.send(request);
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  send_cancel(daemon, request);
  send_cancel(daemon, request);
  // The planner is never released: it stops because it is told to.
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_CANCELLED);
  EXPECT_EQ(answer->num_segments, 0);
  daemon.send(request);  // still on its way when it was cancelled, say
  const std::optional<plan_response_t> again = daemon.answer_to(request, 1);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, plan_response_t::STATUS_CANCELLED);
  EXPECT_EQ(daemon.planner.calls(), 1);
}

TEST(PlanService, ARequestThatWaitsIsCancelledAndNeverPlanned) {
  RunningService daemon;
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send(request_with(2));
  send_cancel(daemon, request_with(2));
  const std::optional<plan_response_t> answer = daemon.answer_to(request_with(2));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_CANCELLED);
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request_with(1)));
  EXPECT_EQ(daemon.planner.calls(), 1);
}

TEST(PlanService, CancellingWhatIsOverOrUnknownIsAnsweredToo) {
  RunningService daemon;
  daemon.send(request_with(1));
  const std::optional<plan_response_t> answer = daemon.answer_to(request_with(1));
  ASSERT_TRUE(answer);
  send_cancel(daemon, request_with(1));
  const std::optional<plan_response_t> again = daemon.answer_to(request_with(1), 1);
  ASSERT_TRUE(again);
  EXPECT_EQ(wire::encode(*again), wire::encode(*answer)) << "the answer that was there";
  send_cancel(daemon, request_with(2));
  EXPECT_EQ(daemon.answer_to(request_with(2))->status, plan_response_t::STATUS_CANCELLED);
  daemon.send(request_with(2));
  EXPECT_EQ(daemon.answer_to(request_with(2), 3)->status, plan_response_t::STATUS_OK)
      << "what the daemon does not know uses up no id";
}

TEST(PlanService, SaysHowFarItIsToThoseWhoWantToKnow) {
  RunningService daemon;
  daemon.planner.hold();
  plan_request_t first = request_with(1);
  first.progress_period_s = 0.001;
  daemon.send(first);
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send(request_with(2));
  plan_request_t third = request_with(3);
  third.progress_period_s = 0.1;
  third.deadline_s = 25.0;
  daemon.send(third);
  const std::string channel = daemon.channels.plan_progress("tester");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(daemon.transport.wait_for_messages_on(channel, 6));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(250))
      << "nobody is told more often than ten times a second";
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(third));
  std::set<std::int64_t> told;
  for (const Bytes& bytes : daemon.transport.published_on(channel)) {
    const plan_progress_t progress = wire::decode<plan_progress_t>(bytes).message.value();
    told.insert(progress.request_id);
    EXPECT_GT(progress.since_receipt_s, 0.0);
    if (progress.request_id != 3) continue;
    EXPECT_EQ(progress.stage, plan_progress_t::WAITING);
    EXPECT_EQ(progress.requests_ahead, 1);
    EXPECT_EQ(progress.deadline_s, 25.0);
  }
  EXPECT_EQ(told, (std::set<std::int64_t>{1, 3}));
}

TEST(PlanService, PagesOfAnAnswerAreSentAgainAlone) {
  RunningService daemon;
  const plan_request_t request = request_with(1, 2000);
  daemon.send(request);
  ASSERT_TRUE(daemon.answer_to(request));
  const std::string channel = daemon.channels.plan_response("tester");
  const std::vector<Bytes> all = daemon.transport.published_on(channel);
  ASSERT_GT(all.size(), 5U);
  missing_pages_t question{};
  question.client_id = "tester";
  question.request_id = 1;
  question.missing = {4, 1, 4, -1, 99};
  question.num_missing = 5;
  daemon.send_on(daemon.channels.missing_pages(), wire::encode(question));
  question.request_id = 7;  // of which there is no answer
  daemon.send_on(daemon.channels.missing_pages(), wire::encode(question));
  daemon.send(request_with(2));
  ASSERT_TRUE(daemon.answer_to(request_with(2), all.size()));
  // The short answer may overtake a page.
  ASSERT_TRUE(daemon.transport.wait_for_messages_on(channel, all.size() + 2 + 1));
  std::vector<Bytes> more = daemon.transport.published_on(channel);
  more.erase(more.begin(), more.begin() + static_cast<std::ptrdiff_t>(all.size()));
  EXPECT_EQ(more.size(), 2U + 1U);
  EXPECT_EQ(std::ranges::count(more, all[1]), 1);
  EXPECT_EQ(std::ranges::count(more, all[4]), 1);
  EXPECT_EQ(daemon.planner.calls(), 2);
}

TEST(PlanService, AsksForPagesOfARequestThatDidNotCome) {
  RunningService daemon;
  const plan_request_t request = request_with(1, 3000);
  const std::vector<Bytes> pages = wire::encode_pages(request);
  ASSERT_GT(pages.size(), 3U);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    if (i != 0 && i != 2) daemon.send_on(daemon.channels.plan_request(), pages[i]);
  }
  const std::string channel = daemon.channels.missing_pages("tester");
  const std::optional<Bytes> bytes = daemon.transport.message_on(channel, 0);
  ASSERT_TRUE(bytes);
  const missing_pages_t question = wire::decode<missing_pages_t>(*bytes).message.value();
  EXPECT_EQ(question.client_id, "tester");
  EXPECT_EQ(question.request_id, 1);
  EXPECT_EQ(question.num_pages, static_cast<std::int32_t>(pages.size()));
  EXPECT_EQ(question.missing, (std::vector<std::int32_t>{0, 2}));
  daemon.send_on(daemon.channels.plan_request(), pages[2]);
  daemon.send_on(daemon.channels.plan_request(), pages[0]);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(without_time(*answer), expected_echo(request));
}

TEST(PlanService, AClientThatFloodsDoesNotKeepAnotherWaiting) {
  ServiceConfig config = with_workers(1, 64);
  config.queue.jobs_of_a_client = 40;
  RunningService daemon(config);
  daemon.planner.hold();
  daemon.send(request_of("flood", 1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  for (std::int64_t id = 2; id <= 100; ++id) daemon.send(request_of("flood", id));
  for (std::int64_t id = 1; id <= 3; ++id) daemon.send(request_of("modest", id));
  plan_request_t marker = request_of("marker", 1);
  marker.scene = "cellar";
  daemon.send(marker);
  ASSERT_TRUE(daemon.answer_to(marker));
  const std::string flood = daemon.channels.plan_response("flood");
  ASSERT_TRUE(daemon.transport.wait_for_messages_on(flood, 99U - 40U)) << "the rest is refused";
  EXPECT_EQ(daemon.transport.published_on(flood).size(), 99U - 40U);
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request_of("modest", 3)));
  // One was being planned, and equal clients alternate: at most one for each of the other's.
  std::size_t flood_answers = 0;
  std::size_t modest_answers = 0;
  for (const auto& message : daemon.transport.published()) {
    if (message.channel == daemon.channels.plan_response("modest")) ++modest_answers;
    if (message.channel == flood && modest_answers < 3) ++flood_answers;
  }
  EXPECT_LE(flood_answers, 99U - 40U + 1U + 3U);
}

TEST(PlanService, ANewcomerFindsRoomInAQueueThatOneClientFilled) {
  RunningService daemon(with_workers(1, 4));
  daemon.planner.hold();
  for (std::int64_t id = 1; id <= 9; ++id) daemon.send(request_of("flood", id));
  daemon.send(request_of("modest", 1));
  daemon.planner.release();
  const std::optional<plan_response_t> answer = daemon.answer_to(request_of("modest", 1));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, PriorityDecidesAmongTheRequestsOfAClient) {
  RunningService daemon;
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  std::vector<plan_request_t> requests{request_with(2), request_with(3), request_with(4)};
  requests[0].priority = plan_request_t::LOW;
  requests[2].priority = plan_request_t::HIGH;
  for (const plan_request_t& request : requests) daemon.send(request);
  plan_request_t marker = request_of("marker", 1);
  marker.scene = "cellar";
  daemon.send(marker);
  ASSERT_TRUE(daemon.answer_to(marker));
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(requests[0]));
  std::vector<std::int64_t> order;
  for (const Bytes& bytes :
       daemon.transport.published_on(daemon.channels.plan_response("tester"))) {
    order.push_back(wire::decode<plan_response_t>(bytes).message->request_id);
  }
  EXPECT_EQ(order, (std::vector<std::int64_t>{1, 4, 3, 2}));
}

TEST(PlanService, AnswersDoNotDependOnTheNumberOfWorkers) {
  constexpr std::int64_t kRequests = 40;
  const auto answers = [](int workers) {
    RunningService daemon(with_workers(workers, 100));
    for (std::int64_t id = 0; id < kRequests; ++id) daemon.send(request_with(id, 400));
    std::vector<Bytes> all;
    for (std::int64_t id = 0; id < kRequests; ++id) {
      all.push_back(without_time(daemon.answer_to(request_with(id, 400)).value()));
    }
    return all;
  };
  EXPECT_EQ(answers(1), answers(4));
}

TEST(PlanService, BodyAndClearanceReachThePlannerAndWitnessesTheClient) {
  const auto result_of = [](const planning::PlanRequest& request) {
    planning::PlanResult result = echo_result(request);
    result.status = planning::Status::kPartial;
    const auto* box = request.body ? std::get_if<motion::BoxShape>(&*request.body) : nullptr;
    const double depth_m = (box ? box->size_m.x() : 0.0) + request.options.clearance_m;
    result.collisions = {{0.5, 1.5, collision::Witness{1.0, 12, 3, depth_m, {1, 2, 3}}}};
    result.collision_names = {{"table", "face 3"}};
    return result;
  };
  RunningService daemon({}, result_of);
  plan_request_t request = request_with(1, 2000);
  request.body = messages::wire_body(motion::BoxShape{{0, 0, 0}, {4, 1, 1}});
  request.clearance_m = 0.25;
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->collisions.size(), 1U);
  const collision_interval_t& interval = answer->collisions[0];
  EXPECT_EQ(interval.has_witness, 1);
  EXPECT_EQ(interval.witness_depth_m, 4.25);
  EXPECT_EQ(interval.witness_object, "table");
  EXPECT_EQ(interval.witness_triangle, 12);
  EXPECT_EQ(interval.witness_feature, "face 3");
  EXPECT_EQ(interval.witness_point_m[2], 3.0);
}

TEST(PlanService, AnotherBodyUnderTheSameIdIsAnotherRequest) {
  RunningService daemon;
  plan_request_t request = request_with(1);
  daemon.send(request);
  ASSERT_TRUE(daemon.answer_to(request));
  request.body = messages::wire_body(motion::SphereShape{{0, 0, 0}, 0.5});
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request, 1);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_INVALID);
}

TEST(PlanService, ABodyThatCannotBeIsInvalidByName) {
  RunningService daemon;
  plan_request_t request = request_with(1);
  request.body.type = 77;
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_INVALID);
  EXPECT_EQ(answer->message,
            "body.type: 77 is unknown; the values are 0 (camera), 1 (box), 2 (sphere), 3 (convex), "
            "4 (mesh), 5 (solid mesh)");
}

}  // namespace
}  // namespace camway::service
