// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "lcmtypes/wire/check.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using testing_support::Bytes;
using testing_support::CClient;
using testing_support::FakeDaemon;

using COccupancyTest = testing_support::ClientTest;

constexpr double kNoHit = std::numeric_limits<double>::infinity();

/// Answers each query by its own numbers, so that each has an answer of its own: occupied where x >
/// 0, and at the distance x, where that is positive.
std::vector<Bytes> answer_by_x(const occupancy_request_t& asked) {
  occupancy_response_t response{};
  response.client_id = asked.client_id;
  response.request_id = asked.request_id;
  const auto hit = [](double x) { return x > 0.0 ? x : -1.0; };
  for (const auto& point : asked.points_m) response.points_occupied.push_back(point[0] > 0.0);
  for (const auto& box : asked.boxes_m) response.boxes_occupied.push_back(box[0] + box[5] > 0.0);
  for (const auto& ball : asked.spheres_m) {
    response.spheres_occupied.push_back(ball[0] + ball[3] > 0.0);
  }
  for (const auto& ray : asked.rays_m) {
    response.rays_hit_m.push_back(hit(ray[0] + 10 * ray[4] + 100 * ray[6]));
  }
  for (const auto& distance : asked.distances_m) {
    response.distances_m.push_back(hit(distance[0] + 10 * distance[3]));
  }
  for (const auto& move : asked.sphere_paths_m) {
    response.sphere_paths_hit_m.push_back(hit(move[0] + 10 * move[5] + 100 * move[6]));
  }
  response.num_points = asked.num_points;
  response.num_boxes = asked.num_boxes;
  response.num_spheres = asked.num_spheres;
  response.num_rays = asked.num_rays;
  response.num_distances = asked.num_distances;
  response.num_sphere_paths = asked.num_sphere_paths;
  return {wire::encode(response)};
}

TEST_F(COccupancyTest, EachQueryGetsItsOwnAnswer) {
  FakeDaemon daemon;
  daemon.on_occupancy = answer_by_x;
  daemon.start();
  CClient client;
  const double points[] = {1, 0, 0, -1, 0, 0, 3, 0, 0};
  const double others[] = {0, 0.5, -3, 0, 0.25, 9, 0, 0, 1};
  const double numbers[] = {0.5, 0.25, -4};
  std::uint8_t occupied[3];
  double hits_m[3];
  camway_client* const c = client.get();
  ASSERT_EQ(camway_occupancy_points(c, "s", points, 3, occupied), CAMWAY_OK) << camway_last_error();
  EXPECT_THAT(occupied, ::testing::ElementsAre(1, 0, 1));
  ASSERT_EQ(camway_occupancy_spheres(c, "s", points, numbers, 3, occupied), CAMWAY_OK);
  EXPECT_THAT(occupied, ::testing::ElementsAre(1, 0, 0));
  ASSERT_EQ(camway_occupancy_boxes(c, "s", points, others, 3, occupied), CAMWAY_OK);
  EXPECT_THAT(occupied, ::testing::ElementsAre(0, 1, 1));
  ASSERT_EQ(camway_occupancy_rays(c, "s", points, others, numbers, 3, hits_m), CAMWAY_OK);
  EXPECT_THAT(hits_m, ::testing::ElementsAre(56.0, 26.5, kNoHit));
  ASSERT_EQ(camway_occupancy_distances(c, "s", points, numbers, 3, hits_m), CAMWAY_OK);
  EXPECT_THAT(hits_m, ::testing::ElementsAre(6.0, 1.5, kNoHit));
  ASSERT_EQ(camway_occupancy_moves(c, "s", points, others, numbers, 3, hits_m), CAMWAY_OK);
  EXPECT_THAT(hits_m, ::testing::ElementsAre(21.0, 114.0, kNoHit));
}

TEST_F(COccupancyTest, NoQueriesNeedNoArrays) {
  FakeDaemon daemon;
  daemon.on_occupancy = answer_by_x;
  daemon.start();
  CClient client;
  EXPECT_EQ(camway_occupancy_points(client.get(), "s", nullptr, 0, nullptr), CAMWAY_OK)
      << camway_last_error();
}

}  // namespace
}  // namespace camway
