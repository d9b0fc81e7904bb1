// SPDX-License-Identifier: MIT
#include "daemon/service/occupancy/occupancy_service.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <camway/cancel_t.hpp>

#include "daemon/scene/mirror/object_mirror.h"
#include "daemon/service/occupancy/occupancy_answer.h"
#include "tests/messages/plan_samples.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using testing::RunningService;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const base::Deadline kNever = base::Deadline::never();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Returns a wall in the plane x = 0.25 that spans 4 x 4 m about the x axis, mirrored at 0.5 m: its
/// voxels are those with x in [0, 0.5].
std::shared_ptr<const scene::Snapshot> wall_scene() {
  auto snapshot = std::make_shared<scene::Snapshot>();
  snapshot->name = "wall";
  snapshot->revision = 3;
  scene::Mesh mesh;
  mesh.vertices = {{0.25, -2, -2}, {0.25, 2, -2}, {0.25, 2, 2}, {0.25, -2, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.objects = {{"wall", 0, 2}};
  scene::ObjectMirror::BuildResult built = scene::ObjectMirror::build(mesh, 0.5);
  EXPECT_TRUE(built.map) << built.error;
  snapshot->occupancy = std::make_shared<const scene::SceneMirror>(built.map);
  return snapshot;
}

occupancy_request_t batch_on(const std::string& scene) {
  occupancy_request_t batch{};
  batch.client_id = "tester";
  batch.request_id = 4;
  batch.scene = scene;
  return batch;
}

void count(occupancy_request_t& batch) {
  batch.num_points = static_cast<std::int32_t>(batch.points_m.size());
  batch.num_boxes = static_cast<std::int32_t>(batch.boxes_m.size());
  batch.num_spheres = static_cast<std::int32_t>(batch.spheres_m.size());
  batch.num_rays = static_cast<std::int32_t>(batch.rays_m.size());
  batch.num_distances = static_cast<std::int32_t>(batch.distances_m.size());
  batch.num_sphere_paths = static_cast<std::int32_t>(batch.sphere_paths_m.size());
}

occupancy_request_t mixed_batch(const std::string& scene) {
  occupancy_request_t batch = batch_on(scene);
  batch.points_m = {{0.3, 0.1, 0.1}, {1.3, 0.1, 0.1}};
  batch.boxes_m = {{0.7, 0, 0, 1, 1, 1}, {-1, 0, 0, 1, 1, 1}};
  batch.spheres_m = {{2, 0, 0, 1}, {2, 0, 0, 1.6}};
  batch.rays_m = {{-3, 0.1, 0.1, 2, 0, 0, 10}, {-3, 0.1, 0.1, -1, 0, 0, kInfinity}};
  batch.distances_m = {{2.5, 0.1, 0.1, 10}, {2.5, 0.1, 0.1, 1.5}};
  batch.sphere_paths_m = {{-3, 0.1, 0.1, 9, 0.1, 0.1, 0.5}, {2, 0.1, 0.1, 9, 0.1, 0.1, 0.5}};
  count(batch);
  return batch;
}

void expect_mixed_answers(const occupancy_response_t& answer) {
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_OK) << answer.message;
  EXPECT_EQ(answer.scene_revision, 3);
  EXPECT_EQ(answer.resolution_m, 0.5);
  EXPECT_EQ(answer.points_occupied, (std::vector<std::int8_t>{1, 0}));
  EXPECT_EQ(answer.boxes_occupied, (std::vector<std::int8_t>{0, 1}));
  EXPECT_EQ(answer.spheres_occupied, (std::vector<std::int8_t>{0, 1}));
  // Other tests cover the rounding of the map; this one covers the order of the answers.
  constexpr double kMapRounding_m = 1e-9;
  ASSERT_EQ(answer.num_rays, 2);
  EXPECT_NEAR(answer.rays_hit_m[0], 3.0, kMapRounding_m);
  EXPECT_EQ(answer.rays_hit_m[1], -1.0);
  ASSERT_EQ(answer.num_distances, 2);
  EXPECT_NEAR(answer.distances_m[0], 2.0, kMapRounding_m);
  EXPECT_EQ(answer.distances_m[1], -1.0);
  ASSERT_EQ(answer.num_sphere_paths, 2);
  EXPECT_NEAR(answer.sphere_paths_hit_m[0], 2.5, kMapRounding_m);
  EXPECT_EQ(answer.sphere_paths_hit_m[1], -1.0);
}

TEST(AnswerBatch, AnswersEveryListInOrder) {
  expect_mixed_answers(answer_batch(*wall_scene(), mixed_batch("wall"), kNever));
}

TEST(AnswerBatch, BeginsNoQueryAfterItsDeadline) {
  const occupancy_response_t answer =
      answer_batch(*wall_scene(), mixed_batch("wall"), base::Deadline::after_s(0.0));
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_TIMEOUT);
  EXPECT_EQ(queries_of(answer), 0);
  EXPECT_TRUE(answer.points_occupied.empty());
  EXPECT_EQ(answer.scene_revision, 3);
  EXPECT_NE(answer.message.find("after 0 of 12 queries"), std::string::npos) << answer.message;
  EXPECT_NE(answer.message.find("occupancy.max_deadline_s"), std::string::npos) << answer.message;
}

TEST(AnswerBatch, SaysThatThereIsNoMap) {
  const occupancy_response_t answer =
      answer_batch(*testing::empty_scene("room"), mixed_batch("room"), kNever);
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_NO_MAP);
  EXPECT_EQ(answer.num_points, 0);
}

TEST(AnswerBatch, NamesTheQueryThatMakesNoSense) {
  const auto fault_of = [](const std::function<void(occupancy_request_t&)>& change) {
    occupancy_request_t batch = mixed_batch("wall");
    change(batch);
    return batch_fault(batch);
  };
  EXPECT_EQ(batch_fault(mixed_batch("wall")), "");
  EXPECT_EQ(fault_of([](auto& b) { b.points_m[1][2] = kNaN; }), "points_m[1]: is not finite");
  EXPECT_EQ(fault_of([](auto& b) { b.boxes_m[0][5] = kInfinity; }), "boxes_m[0]: is not finite");
  EXPECT_EQ(fault_of([](auto& b) { b.boxes_m[1][4] = -1; }),
            "boxes_m[1]: has a minimum above its maximum");
  EXPECT_EQ(fault_of([](auto& b) { b.spheres_m[0][3] = -1; }),
            "spheres_m[0]: has a radius that is not at least 0");
  EXPECT_EQ(fault_of([](auto& b) { b.spheres_m[0][3] = kNaN; }),
            "spheres_m[0]: has a radius that is not at least 0");
  EXPECT_EQ(fault_of([](auto& b) { b.rays_m[0][3] = 0; }), "rays_m[0]: has no direction");
  EXPECT_EQ(fault_of([](auto& b) { b.rays_m[1][6] = -1; }),
            "rays_m[1]: has a range that is not at least 0");
  EXPECT_EQ(fault_of([](auto& b) { b.distances_m[1][0] = kNaN; }),
            "distances_m[1]: has a point that is not finite");
  EXPECT_EQ(fault_of([](auto& b) { b.sphere_paths_m[1][4] = kInfinity; }),
            "sphere_paths_m[1]: has an end that is not finite");
  EXPECT_EQ(fault_of([](auto& b) {
              b.sphere_paths_m[0][0] = -1e308;
              b.sphere_paths_m[0][3] = 1e308;
            }),
            "sphere_paths_m[0]: is too long");
  EXPECT_EQ(fault_of([](auto& b) { b.sphere_paths_m[0][6] = kNaN; }),
            "sphere_paths_m[0]: has a radius that is not at least 0");
  occupancy_request_t bad = mixed_batch("wall");
  bad.rays_m[0][0] = kNaN;
  const occupancy_response_t answer = answer_batch(*wall_scene(), bad, kNever);
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_INVALID);
  EXPECT_EQ(answer.num_points, 0) << "all or nothing";
}

/// Returns the only answer of `daemon` to `message`.
occupancy_response_t ask(RunningService& daemon, Bytes message) {
  const std::string channel = daemon.channels.occupancy_response("tester");
  const std::size_t before = daemon.transport.published_on(channel).size();
  daemon.send_on(daemon.channels.occupancy_request(), std::move(message));
  EXPECT_TRUE(daemon.transport.wait_for_messages_on(channel, before + 1));
  const Bytes bytes = daemon.transport.published_on(channel).back();
  wire::Decoded<occupancy_response_t> decoded = wire::decode<occupancy_response_t>(bytes);
  EXPECT_TRUE(decoded.message) << decoded.fault.text("");
  return decoded.message.value_or(occupancy_response_t{});
}

TEST(OccupancyService, AnswersOverTheWire) {
  RunningService daemon;
  daemon.scenes.put(wall_scene());
  const occupancy_response_t answer = ask(daemon, wire::encode(mixed_batch("wall")));
  EXPECT_EQ(answer.request_id, 4);
  EXPECT_GT(answer.utime, 0);
  expect_mixed_answers(answer);
  EXPECT_NE(daemon.log_text().find("status=ok "), std::string::npos) << daemon.log_text();
}

TEST(OccupancyService, EveryFaultHasItsStatus) {
  RunningService daemon;
  daemon.scenes.put(wall_scene());
  EXPECT_EQ(ask(daemon, wire::encode(mixed_batch("room"))).status,
            occupancy_response_t::STATUS_NO_MAP);
  const occupancy_response_t unknown = ask(daemon, wire::encode(mixed_batch("attic")));
  EXPECT_EQ(unknown.status, occupancy_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_EQ(unknown.message, "scene: 'attic' is unknown; there are: 'hall' 'room' 'wall'");
  Bytes truncated = wire::encode(mixed_batch("wall"));
  truncated.pop_back();
  const occupancy_response_t malformed = ask(daemon, truncated);
  EXPECT_EQ(malformed.status, occupancy_response_t::STATUS_MALFORMED);
  EXPECT_EQ(malformed.request_id, 4);
  EXPECT_NE(malformed.message.find("sphere_paths_m"), std::string::npos) << malformed.message;
}

TEST(OccupancyService, TheLargestBatchGetsAnAnswerThatFits) {
  RunningService daemon;
  daemon.scenes.put(wall_scene());
  occupancy_request_t batch = batch_on("wall");
  while (static_cast<std::size_t>(batch.getEncodedSize()) + 32 <= wire::kMaxMessageBytes) {
    batch.distances_m.push_back({2.5, 0.1, 0.1, 10});
    count(batch);
  }
  const occupancy_response_t answer = ask(daemon, wire::encode(batch));
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_OK);
  EXPECT_EQ(answer.num_distances, batch.num_distances);
  EXPECT_LE(wire::encode(answer).size(), wire::kMaxMessageBytes);
}

TEST(OccupancyService, SharesTheQueueWithPlanning) {
  ServiceConfig config;
  config.queue.jobs = 1;
  RunningService daemon(config);
  daemon.scenes.put(wall_scene());
  daemon.planner.hold();
  daemon.send(testing::request_with(1));
  ASSERT_TRUE(daemon.planner.wait_for_calls(1));
  daemon.send_on(daemon.channels.occupancy_request(), wire::encode(mixed_batch("wall")));
  occupancy_request_t another = mixed_batch("wall");
  another.request_id = 5;
  EXPECT_EQ(ask(daemon, wire::encode(another)).status, occupancy_response_t::STATUS_OVERLOADED);
  daemon.planner.release();
}

/// A daemon whose only worker plans until it is released.
class BusyOccupancyService : public ::testing::Test {
 protected:
  BusyOccupancyService() {
    daemon_.scenes.put(wall_scene());
    daemon_.planner.hold();
    daemon_.send(testing::request_with(1));
    EXPECT_TRUE(daemon_.planner.wait_for_calls(1));
  }

  static ServiceConfig config() {
    ServiceConfig config = testing::with_workers(1, 10);
    config.occupancy_deadline.max_s = 30.0;
    return config;
  }

  static occupancy_request_t batch(std::int64_t id) {
    occupancy_request_t batch = mixed_batch("wall");
    batch.request_id = id;
    return batch;
  }

  void send(const occupancy_request_t& batch) {
    daemon_.send_on(daemon_.channels.occupancy_request(), wire::encode(batch));
  }

  occupancy_response_t cancel(std::int64_t id) {
    cancel_t message{};
    message.client_id = "tester";
    message.request_id = id;
    const std::string answers = daemon_.channels.occupancy_response("tester");
    const std::size_t before = daemon_.transport.published_on(answers).size();
    daemon_.send_on(daemon_.channels.cancel_occupancy(), wire::encode(message));
    EXPECT_TRUE(daemon_.transport.wait_for_messages_on(answers, before + 1));
    return *wire::decode<occupancy_response_t>(daemon_.transport.published_on(answers).back())
                .message;
  }

  RunningService daemon_{config()};
};

TEST_F(BusyOccupancyService, DeadlinesRunFromTheReceipt) {
  occupancy_request_t hasty = batch(7);
  hasty.deadline_s = 0.02;
  const occupancy_response_t answer = ask(daemon_, wire::encode(hasty));
  EXPECT_EQ(answer.status, occupancy_response_t::STATUS_TIMEOUT);
  EXPECT_NE(answer.message.find("waited for a worker"), std::string::npos) << answer.message;
}

TEST_F(BusyOccupancyService, RefusesDeadlinesThatAreNone) {
  for (const double deadline_s : {-1.0, kNaN}) {
    occupancy_request_t bad = batch(7);
    bad.deadline_s = deadline_s;
    const occupancy_response_t answer = ask(daemon_, wire::encode(bad));
    EXPECT_EQ(answer.status, occupancy_response_t::STATUS_INVALID);
    EXPECT_EQ(answer.message.find("deadline_s: is "), 0U) << answer.message;
  }
}

TEST_F(BusyOccupancyService, WhatIsCalledOffIsAnsweredOnceAndAtOnce) {
  send(batch(7));
  EXPECT_EQ(cancel(7).message, "cancelled by its client");
  EXPECT_EQ(cancel(7).message, "the daemon knows no such request");
  EXPECT_EQ(cancel(7).status, occupancy_response_t::STATUS_CANCELLED);
  daemon_.planner.release();
  EXPECT_EQ(ask(daemon_, wire::encode(batch(8))).request_id, 8) << "7 is not answered again";
  EXPECT_EQ(daemon_.transport.published_on(daemon_.channels.occupancy_response("tester")).size(),
            4U);
}

TEST_F(BusyOccupancyService, TheSameRequestAgainIsAnsweredOnce) {
  send(batch(7));
  occupancy_request_t later = batch(7);
  later.utime = 99;
  send(later);
  occupancy_request_t other = batch(7);
  other.points_m[0][0] += 1.0;
  const occupancy_response_t refused = ask(daemon_, wire::encode(other));
  EXPECT_EQ(refused.status, occupancy_response_t::STATUS_INVALID);
  EXPECT_EQ(refused.message.find("request_id: 7 is that of another request"), 0U);
  daemon_.planner.release();
  const std::string answers = daemon_.channels.occupancy_response("tester");
  ASSERT_TRUE(daemon_.transport.wait_for_messages_on(answers, 2));
  EXPECT_EQ(ask(daemon_, wire::encode(batch(8))).request_id, 8);
  EXPECT_EQ(daemon_.transport.published_on(answers).size(), 3U);
  EXPECT_EQ(ask(daemon_, wire::encode(other)).status, occupancy_response_t::STATUS_OK)
      << "the ids are free again";
}

TEST(OccupancyService, DeadlinesAreCutToTheMaximum) {
  ServiceConfig config = testing::with_workers(1, 10);
  config.occupancy_deadline = {.default_s = 1e-9, .max_s = 1e-9};
  RunningService daemon(config);
  daemon.scenes.put(wall_scene());
  occupancy_request_t batch = mixed_batch("wall");
  EXPECT_EQ(ask(daemon, wire::encode(batch)).status, occupancy_response_t::STATUS_TIMEOUT);
  batch.deadline_s = 1000.0;
  EXPECT_EQ(ask(daemon, wire::encode(batch)).status, occupancy_response_t::STATUS_TIMEOUT);
}

}  // namespace
}  // namespace camway::service
