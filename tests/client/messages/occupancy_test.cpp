// SPDX-License-Identifier: MIT
#include "client/messages/occupancy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/pages.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using wire::Bytes;

TEST(OccupancyRequests, SplitALargeBatchWithoutLossOrReordering) {
  OccupancyBatch batch;
  batch.scene = "office";
  const auto number = [](std::size_t i) { return static_cast<double>(i); };
  for (std::size_t i = 0; i < 6000; ++i) {
    batch.points_m.push_back({number(i), 1, 2});
    batch.boxes.push_back({{number(i), 0, 0}, {number(i), 1, 1}});
    batch.spheres.push_back({{number(i), 0, 0}, 0.5});
    batch.rays.push_back({{number(i), 0, 0}, {0, 0, 1}, 9});
    batch.distances.push_back({{number(i), 0, 0}, 3});
    batch.sphere_paths.push_back({{0, 0, 0}, {number(i), 0, 0}, 3});
  }
  std::size_t points = 0, boxes = 0, spheres = 0, rays = 0, distances = 0, paths = 0;
  const auto requests = to_requests(batch, "me");
  for (const occupancy_request_t& request : requests) {
    const Bytes bytes = wire::encode(request);
    ASSERT_LE(bytes.size(), wire::kMaxMessageBytes);
    ASSERT_EQ(wire::check(wire::layout_of<occupancy_request_t>(), bytes), std::nullopt);
    for (const auto& query : request.points_m) ASSERT_EQ(query[0], number(points++));
    for (const auto& query : request.boxes_m) ASSERT_EQ(query[3], number(boxes++));
    for (const auto& query : request.spheres_m) ASSERT_EQ(query[0], number(spheres++));
    for (const auto& query : request.rays_m) ASSERT_EQ(query[0], number(rays++));
    for (const auto& query : request.distances_m) ASSERT_EQ(query[0], number(distances++));
    for (const auto& query : request.sphere_paths_m) ASSERT_EQ(query[3], number(paths++));
  }
  EXPECT_THAT((std::vector{points, boxes, spheres, rays, distances, paths}),
              ::testing::Each(6000u));
  // There are no more messages than needed: only the last may be less than nearly full.
  EXPECT_EQ(requests.size(), (6000u * (24 + 48 + 32 + 56 + 32 + 56) + 59'899) / 59'900);
}

TEST(OccupancyRequests, AnEmptyBatchIsOneRequest) {
  EXPECT_EQ(to_requests(OccupancyBatch{}, "me").size(), 1u);
}

TEST(OccupancyAnswers, MustBeAsManyAsTheQuestions) {
  OccupancyBatch batch;
  batch.points_m.resize(2);
  batch.rays.resize(1);
  const occupancy_request_t request = to_requests(batch, "me")[0];
  occupancy_response_t response{};
  response.num_points = 2;
  response.points_occupied = {1, 0};
  OccupancyAnswer answer;
  EXPECT_THAT(*append(request, response, answer), HasSubstr("not as many"));
  response.num_rays = 1;
  response.rays_hit_m = {NAN};
  EXPECT_THAT(*append(request, response, answer), HasSubstr("not a finite number"));
  response.rays_hit_m = {-1.0};
  answer = {};
  EXPECT_EQ(append(request, response, answer), std::nullopt);
  EXPECT_EQ(answer.points_occupied, (std::vector<bool>{true, false}));
  EXPECT_EQ(answer.rays_hit_m, (std::vector<std::optional<double>>{std::nullopt}));
}

}  // namespace
}  // namespace camway
