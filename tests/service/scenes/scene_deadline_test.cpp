// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <latch>
#include <limits>
#include <optional>
#include <string>

#include <camway/cancel_t.hpp>

#include "daemon/service/scenes/scene_service.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using testing::RunningService;

constexpr char kSlow[] = "slow";
constexpr double kHardly_s = 1e-3;

ServiceConfig config() {
  ServiceConfig config;
  config.scene_rules.mirror_voxels = 1'000'000'000;
  config.change_deadline = {.default_s = 500.0, .max_s = 1000.0};
  return config;
}

scene_request_t put_box(std::int64_t id, const std::string& scene, double side_m,
                        double deadline_s = 0.0) {
  scene_request_t request{};
  request.client_id = "tester";
  request.request_id = id;
  request.operation = scene_request_t::PUT;
  request.scene = scene;
  request.object = "box" + std::to_string(id);
  request.kind = scene_request_t::BOX;
  for (double& side : request.size_m) side = side_m;
  request.deadline_s = deadline_s;
  return request;
}

/// Returns a change in a scene whose mirror is so fine that the box takes minutes.
scene_request_t put_slow(std::int64_t id, double deadline_s = 0.0) {
  return put_box(id, kSlow, 14.0, deadline_s);
}

/// A service with a scene whose changes may take long.
class SceneDeadline : public ::testing::Test {
 protected:
  explicit SceneDeadline(const ServiceConfig& with = config()) : running_(with) {
    scene_request_t load{};
    load.client_id = "loader";
    load.request_id = 1;
    load.operation = scene_request_t::LOAD;
    load.scene = kSlow;
    load.occupancy_resolution_m = 0.002;
    send(load);
    EXPECT_TRUE(answer_to(load));
    before_ = running_.scenes.kept(kSlow);
  }

  void send(const scene_request_t& request) {
    running_.send_on(running_.channels.scene_request(), wire::encode(request));
  }
  void cancel(std::int64_t id) {
    cancel_t cancel{};
    cancel.client_id = "tester";
    cancel.request_id = id;
    running_.send_on(running_.channels.cancel_scene(), wire::encode(cancel));
  }

  /// Returns nothing if no answer comes.
  std::optional<scene_response_t> answer_to(const scene_request_t& request) {
    return answer(request.client_id, request.request_id);
  }
  std::optional<scene_response_t> answer(const std::string& client, std::int64_t id) {
    const std::string channel = running_.channels.scene_response(client);
    for (std::size_t seen = 0;; ++seen) {
      const auto bytes = running_.transport.message_on(channel, seen);
      if (!bytes) return std::nullopt;
      const auto decoded = wire::decode<scene_response_t>(*bytes);
      if (decoded.message && decoded.message->request_id == id) return decoded.message;
    }
  }
  [[nodiscard]] std::size_t answers() const {
    return running_.transport.published_on(running_.channels.scene_response("tester")).size();
  }

  void expect_status(const scene_request_t& request, std::int32_t status) {
    const auto answer = answer_to(request);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, status) << answer->message;
  }

  /// Expects the slow scene to be unchanged in revision, digest and history.
  void expect_as_before() {
    const scene::SceneStore::Kept now = running_.scenes.kept(kSlow);
    EXPECT_EQ(now.newest, before_.newest);
    EXPECT_EQ(now.revisions.size(), before_.revisions.size());
  }

  /// Expects that the next change of the slow scene waits for no cancelled one, and that its answer
  /// comes after all before it, each of which came once.
  void expect_next_is_made(std::int64_t id, std::size_t answers_before) {
    const scene_request_t small = put_box(id, kSlow, 0.01);
    send(small);
    expect_status(small, scene_response_t::STATUS_OK);
    EXPECT_EQ(running_.scenes.find(kSlow)->revision, before_.newest->revision + 1);
    EXPECT_EQ(answers(), answers_before + 1);
  }

  RunningService running_;
  scene::SceneStore::Kept before_;
};

TEST_F(SceneDeadline, EndsAChangeThatIsBeingMade) {
  const scene_request_t slow = put_slow(1, 0.1);
  send(slow);
  const auto answer = answer_to(slow);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, scene_response_t::STATUS_TIMEOUT);
  EXPECT_THAT(answer->message, HasSubstr("scenes.max_deadline_s"));
  expect_as_before();
  expect_next_is_made(2, 1);
}

TEST_F(SceneDeadline, EndsASmallChangeWhoseDeadlineHasPassedWhenItBegins) {
  for (std::int64_t id = 1; id <= 50; ++id) {
    const scene_request_t small = put_box(id, kSlow, 0.01, 1e-9);
    send(small);
    expect_status(small, scene_response_t::STATUS_TIMEOUT);
  }
  expect_as_before();
  expect_next_is_made(100, 50);
}

/// One change occupies the only worker, because a listener of it does not return.
class SceneDeadlineInAQueue : public SceneDeadline {
 protected:
  SceneDeadlineInAQueue() : SceneDeadline(one_worker()) {
    running_.scenes.on_change([this] {
      if (!entered_.try_wait()) entered_.count_down();
      done_.wait();
    });
    send(first_);
    entered_.wait();
  }
  ~SceneDeadlineInAQueue() override {
    release();
    running_.scenes.on_change(nullptr);
  }

  static ServiceConfig one_worker() {
    ServiceConfig with = config();
    with.scene_workers = 1;
    return with;
  }
  void release() {
    if (!done_.try_wait()) done_.count_down();
  }

  const scene_request_t first_ = put_box(100, "room", 1.0);
  std::latch entered_{1};
  std::latch done_{1};
};

TEST_F(SceneDeadlineInAQueue, EndsAChangeThatWaits) {
  const scene_request_t waiting = put_box(1, kSlow, 0.01, kHardly_s);
  send(waiting);
  expect_status(waiting, scene_response_t::STATUS_TIMEOUT);
  EXPECT_EQ(answers(), 1U) << "the one before it is still at it";
  release();
  expect_status(first_, scene_response_t::STATUS_OK);
  expect_as_before();
}

TEST_F(SceneDeadlineInAQueue, CancelsAChangeThatWaits) {
  const scene_request_t waiting = put_box(1, kSlow, 0.01);
  send(waiting);
  cancel(1);
  expect_status(waiting, scene_response_t::STATUS_CANCELLED);
  EXPECT_EQ(answers(), 1U);
  release();
  expect_status(first_, scene_response_t::STATUS_OK);
  expect_as_before();
}

TEST_F(SceneDeadlineInAQueue, WhatIsInForceKeepsItsAnswer) {
  cancel(first_.request_id);
  const scene_request_t waiting = put_box(1, kSlow, 0.01, kHardly_s);
  send(waiting);
  expect_status(waiting, scene_response_t::STATUS_TIMEOUT);  // so the cancel was read
  EXPECT_EQ(answers(), 1U);
  release();
  expect_status(first_, scene_response_t::STATUS_OK);
  EXPECT_TRUE(running_.scenes.find("room")->find(first_.object));
}

TEST_F(SceneDeadline, CancelsAChangeThatIsBeingMade) {
  const scene_request_t slow = put_slow(1);
  send(slow);
  cancel(1);
  expect_status(slow, scene_response_t::STATUS_CANCELLED);
  expect_as_before();
  send(slow);  // the answer is remembered
  ASSERT_TRUE(running_.transport.message_on(running_.channels.scene_response("tester"), 1));
  EXPECT_EQ(running_.transport.published_on(running_.channels.scene_response("tester"))[0],
            running_.transport.published_on(running_.channels.scene_response("tester"))[1]);
  expect_next_is_made(2, 2);
}

TEST_F(SceneDeadline, AnswersACancelOfWhatIsAnsweredOrUnknown) {
  const scene_request_t small = put_box(1, kSlow, 0.01);
  send(small);
  expect_status(small, scene_response_t::STATUS_OK);
  cancel(1);
  const std::string channel = running_.channels.scene_response("tester");
  ASSERT_TRUE(running_.transport.message_on(channel, 1));
  EXPECT_EQ(running_.transport.published_on(channel)[0],
            running_.transport.published_on(channel)[1]);
  cancel(7);
  const auto unknown = answer("tester", 7);
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->status, scene_response_t::STATUS_CANCELLED);
  EXPECT_THAT(unknown->message, HasSubstr("knows no such request"));
  const scene_request_t seventh = put_box(7, kSlow, 0.01);
  send(seventh);
  ASSERT_TRUE(running_.transport.message_on(channel, 3));
  EXPECT_EQ(running_.scenes.find(kSlow)->revision, before_.newest->revision + 2)
      << "what is unknown is not remembered";
}

TEST_F(SceneDeadline, AnswersACancelThatItCannotRead) {
  cancel_t bad{};
  bad.client_id = "tester";
  bad.request_id = 3;
  Bytes bytes = wire::encode(bad);
  bytes.pop_back();
  running_.send_on(running_.channels.cancel_scene(), bytes);
  const auto said = answer("tester", 3);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->status, scene_response_t::STATUS_MALFORMED);
}

TEST_F(SceneDeadline, RefusesWhatIsNone) {
  std::int64_t id = 0;
  for (const double deadline_s : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const scene_request_t request = put_box(++id, kSlow, 0.01, deadline_s);
    send(request);
    const auto answer = answer_to(request);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, scene_response_t::STATUS_INVALID);
    EXPECT_THAT(answer->message, HasSubstr("deadline_s"));
  }
  expect_as_before();
}

TEST(SceneDeadlines, AreTheDefaultWhereNoneIsNamedAndAtMostTheLongest) {
  for (const double asked_s : {0.0, 1e9}) {
    ServiceConfig with = config();
    with.change_deadline = {.default_s = asked_s == 0.0 ? 0.05 : 0.01, .max_s = 0.05};
    RunningService running(with);
    scene::ObjectOptions options;
    options.occupancy_resolution_m = 0.002;
    options.mirror_voxels = with.scene_rules.mirror_voxels;
    running.scenes.put(scene::assemble(kSlow, 1, {}, options));
    const std::string channel = running.channels.scene_response("tester");
    running.send_on(running.channels.scene_request(), wire::encode(put_slow(1, asked_s)));
    const auto bytes = running.transport.message_on(channel, 0);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(wire::decode<scene_response_t>(*bytes).message->status,
              scene_response_t::STATUS_TIMEOUT);
    EXPECT_TRUE(running.scenes.find(kSlow)->objects.empty());
  }
}

}  // namespace
}  // namespace camway::service
