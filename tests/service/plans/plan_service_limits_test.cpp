// SPDX-License-Identifier: MIT
// Requests that the service refuses because of its limits; the rest is in plan_service_test.cpp.
#include <gtest/gtest.h>

#include "daemon/service/plans/plan_service.h"
#include "tests/messages/plan_samples.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using testing::request_with;
using testing::RunningService;
using testing::with_workers;

TEST(PlanService, RefusesWhatTheQueueCannotHoldAndTakesItLater) {
  RunningService daemon(with_workers(1, 1));
  daemon.planner.hold();
  daemon.send(request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send(request_with(2));
  const plan_request_t refused = request_with(3);
  daemon.send(refused);
  const std::optional<plan_response_t> answer = daemon.answer_to(refused);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_OVERLOADED);
  EXPECT_NE(answer->message.find("send it again later"), std::string::npos) << answer->message;
  daemon.planner.release();
  ASSERT_TRUE(daemon.answer_to(request_with(2)));
  daemon.send(refused);
  const std::optional<plan_response_t> later = daemon.answer_to(refused, 3);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, RefusesRequestsThatTogetherAreTooLargeAndTakesThemLater) {
  ServiceConfig config = with_workers(1, 10);
  config.request_bytes = 3 * static_cast<std::size_t>(request_with(1).getEncodedSize());
  RunningService daemon(config);
  daemon.planner.hold();
  for (std::int64_t id = 1; id <= 3; ++id) daemon.send(request_with(id));
  const plan_request_t refused = request_with(4);
  daemon.send(refused);
  const std::optional<plan_response_t> answer = daemon.answer_to(refused);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_OVERLOADED);
  EXPECT_NE(answer->message.find("queue.request_bytes"), std::string::npos) << answer->message;
  daemon.planner.release();
  for (std::int64_t id = 1; id <= 3; ++id) ASSERT_TRUE(daemon.answer_to(request_with(id)));
  daemon.send(refused);
  EXPECT_EQ(daemon.answer_to(refused, 4)->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, RefusesMoreKeyframesThanConfigured) {
  ServiceConfig config = with_workers(1, 10);
  config.keyframes = 5;
  RunningService daemon(config);
  daemon.send(request_with(1, 6));
  const std::optional<plan_response_t> answer = daemon.answer_to(request_with(1, 6));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_LIMIT);
  EXPECT_NE(answer->message.find("planning.keyframes"), std::string::npos) << answer->message;
  daemon.send(request_with(2, 5));
  EXPECT_EQ(daemon.answer_to(request_with(2, 5))->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, RefusesAnswersOfMorePagesThanConfigured) {
  ServiceConfig config = with_workers(1, 10);
  config.answer_pages = 1;
  RunningService daemon(config);
  const plan_request_t long_one = request_with(1, 400);
  daemon.send(long_one);
  const std::optional<plan_response_t> answer = daemon.answer_to(long_one);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_LIMIT);
  EXPECT_NE(answer->message.find("queue.answer_pages"), std::string::npos) << answer->message;
  EXPECT_TRUE(answer->segments.empty());
  daemon.send(request_with(2, 50));
  EXPECT_EQ(daemon.answer_to(request_with(2, 50))->status, plan_response_t::STATUS_OK);
}

TEST(PlanService, DoesNotAnswerForAnOlderSceneThanAskedFor) {
  RunningService daemon;
  plan_request_t request = request_with(1);
  request.least_revision = 1'000;
  daemon.send(request);
  const std::optional<plan_response_t> answer = daemon.answer_to(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_OLD_SCENE);
  EXPECT_NE(answer->message.find("least_revision: is 1000"), std::string::npos) << answer->message;
  EXPECT_GT(answer->scene_revision, 0);
  EXPECT_EQ(answer->num_segments, 0);
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request, 1)->status, plan_response_t::STATUS_OLD_SCENE)
      << "not remembered, but checked again";
  request.request_id = 2;
  request.least_revision = answer->scene_revision;
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request)->status, plan_response_t::STATUS_OK);
  request.request_id = 3;
  request.least_revision = -1;
  daemon.send(request);
  EXPECT_EQ(daemon.answer_to(request)->status, plan_response_t::STATUS_INVALID);
}

}  // namespace
}  // namespace camway::service
