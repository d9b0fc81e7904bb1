// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::Bytes;
using testing_support::FakeDaemon;
using testing_support::quick;

using AskOccupancyTest = testing_support::ClientTest;

/// Answers every point, box and sphere by the sign of its first number, and every other query with
/// that number.
std::vector<Bytes> echo(const occupancy_request_t& request, std::int64_t revision) {
  occupancy_response_t response{};
  response.client_id = request.client_id;
  response.request_id = request.request_id;
  response.scene_revision = revision;
  response.resolution_m = 0.25;
  for (const auto& q : request.points_m) response.points_occupied.push_back(q[0] > 0);
  for (const auto& q : request.boxes_m) response.boxes_occupied.push_back(q[0] > 0);
  for (const auto& q : request.spheres_m) response.spheres_occupied.push_back(q[0] > 0);
  for (const auto& q : request.rays_m) response.rays_hit_m.push_back(q[0]);
  for (const auto& q : request.distances_m) response.distances_m.push_back(q[0]);
  for (const auto& q : request.sphere_paths_m) response.sphere_paths_hit_m.push_back(q[0]);
  response.num_points = request.num_points;
  response.num_boxes = request.num_boxes;
  response.num_spheres = request.num_spheres;
  response.num_rays = request.num_rays;
  response.num_distances = request.num_distances;
  response.num_sphere_paths = request.num_sphere_paths;
  return {wire::encode(response)};
}

OccupancyBatch large_batch() {
  OccupancyBatch batch;
  for (int i = 0; i < 3000; ++i) {
    const double x = i % 2 == 0 ? 1.0 + i : -1.0;
    batch.points_m.push_back({x, 0, 0});
    batch.boxes.push_back({{x, 0, 0}, {x, 0, 0}});
    batch.spheres.push_back({{x, 0, 0}, 1});
    batch.rays.push_back({{x, 0, 0}, {1, 0, 0}, 1});
    batch.distances.push_back({{x, 0, 0}, 1});
    batch.sphere_paths.push_back({{x, 0, 0}, {x, 0, 0}, 1});
  }
  return batch;
}

TEST_F(AskOccupancyTest, AsksOccupancyInPartsAndJoinsTheAnswers) {
  FakeDaemon daemon;
  daemon.on_occupancy = [](const occupancy_request_t& request) { return echo(request, 5); };
  daemon.start();
  Client client(quick());
  const OccupancyBatch batch = large_batch();
  const OccupancyAnswer answer = client.occupancy(batch);
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.scene_revision, 5);
  EXPECT_EQ(answer.resolution_m, 0.25);
  ASSERT_EQ(answer.points_occupied.size(), 3000u);
  ASSERT_EQ(answer.distances_m.size(), 3000u);
  ASSERT_EQ(answer.sphere_paths_hit_m.size(), 3000u);
  for (std::size_t i = 0; i < 3000; ++i) {
    const bool even = i % 2 == 0;
    ASSERT_EQ(answer.points_occupied[i], even);
    ASSERT_EQ(answer.boxes_occupied[i], even);
    ASSERT_EQ(answer.spheres_occupied[i], even);
    ASSERT_EQ(answer.rays_hit_m[i].has_value(), even);
    ASSERT_EQ(answer.distances_m[i], even ? std::optional(1.0 + double(i)) : std::nullopt);
    ASSERT_EQ(answer.sphere_paths_hit_m[i], answer.distances_m[i]);
  }
}

TEST_F(AskOccupancyTest, NeverMixesTwoRevisionsOfAScene) {
  int calls = 0;
  FakeDaemon daemon;
  daemon.on_occupancy = [&](const occupancy_request_t& request) {
    return echo(request, ++calls <= 2 ? 1 : 2);  // changes after two of the parts
  };
  daemon.start();
  Client client(quick());
  const OccupancyAnswer answer = client.occupancy(large_batch());
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.scene_revision, 2);
  EXPECT_EQ(answer.points_occupied.size(), 3000u);

  daemon.stop();
  FakeDaemon restless;
  restless.on_occupancy = [&](const occupancy_request_t& request) {
    return echo(request, ++calls);
  };
  restless.start();
  EXPECT_THAT(client.occupancy(large_batch()).error, HasSubstr("the scene changed each time"));
}

TEST_F(AskOccupancyTest, CallsOffWhatNobodyWaitsForAfterADeadline) {
  std::atomic<std::int64_t> first = 0;
  std::atomic<std::int64_t> called_off = 0;
  FakeDaemon daemon;
  daemon.on_occupancy = [&](const occupancy_request_t& request) {
    EXPECT_EQ(request.deadline_s, 0.5);
    if (first == 0) first = request.request_id;
    if (request.request_id != first) return std::vector<Bytes>{};
    occupancy_response_t response{};
    response.client_id = request.client_id;
    response.request_id = request.request_id;
    response.status = occupancy_response_t::STATUS_TIMEOUT;
    response.message = "too slow";
    return std::vector<Bytes>{wire::encode(response)};
  };
  daemon.on_cancel_occupancy = [&](const cancel_t& cancel) {
    called_off = cancel.request_id;
    return std::vector<Bytes>{};
  };
  daemon.start();
  Client client(quick());
  OccupancyBatch batch = large_batch();
  batch.deadline_s = 0.5;
  const OccupancyAnswer answer = client.occupancy(batch);
  EXPECT_EQ(answer.status, Status::kTimeout);
  EXPECT_THAT(answer.error, HasSubstr("too slow"));
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (called_off == 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_NE(called_off, 0);
  EXPECT_NE(called_off, first);
}

TEST_F(AskOccupancyTest, PassesOnWhyThereIsNoOccupancy) {
  FakeDaemon daemon;
  daemon.on_occupancy = [](const occupancy_request_t& request) {
    occupancy_response_t response{};
    response.client_id = request.client_id;
    response.request_id = request.request_id;
    response.status = occupancy_response_t::STATUS_NO_MAP;
    response.message = "no map here";
    return std::vector<Bytes>{wire::encode(response)};
  };
  daemon.start();
  Client client(quick());
  const OccupancyAnswer answer = client.occupancy(large_batch());
  EXPECT_EQ(answer.status, Status::kNoMap);
  EXPECT_THAT(answer.error, HasSubstr("no map here"));
  EXPECT_TRUE(answer.points_occupied.empty());
}

}  // namespace
}  // namespace camway
