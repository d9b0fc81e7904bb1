// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

constexpr double kResolution_m = 0.125;
/// Voxels that a triangle touches are occupied, so an occupied point is at most one voxel's
/// diagonal from a triangle.
const double kReach_m = kResolution_m * std::sqrt(3.0);

class OccupancyTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    // The surface of the cube [0, 4]^3 in empty space.
    {
      std::ofstream scene(file("cube.obj"));
      scene << "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\n"
               "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    }
    start_daemon_with_scenes(
        {"cube=" + file("cube.obj") + ",occupancy=0.125", "bare=" + file("cube.obj")});
  }
};

TEST_F(OccupancyTest, AnswersEveryKindOfQuestion) {
  OccupancyBatch batch;
  batch.scene = "cube";
  batch.points_m = {{2, 2, 0}, {2, 2, 2}, {9, 9, 9}};
  batch.boxes = {{{1, 1, 1}, {3, 3, 3}}, {{3, 3, 3}, {5, 5, 5}}, {{6, 6, 6}, {7, 7, 7}}};
  batch.spheres = {{{2, 2, 2}, 1.0}, {{2, 2, 2}, 2.1}, {{8, 2, 2}, 3.0}};
  batch.rays = {
      {{-3, 2, 2}, {1, 0, 0}, 10}, {{-3, 2, 2}, {-1, 0, 0}, 10}, {{2, 2, 2}, {0, 5, 0}, 9}};
  batch.distances = {{{7, 2, 2}, 10}, {{7, 2, 2}, 1}, {{2, 2, 2}, 10}};
  batch.sphere_paths = {{{7, 2, 2}, {2, 2, 2}, 0.5}, {{2, 2, 2}, {3, 2, 2}, 0.5}};
  Client client(patient());
  const OccupancyAnswer answer = client.occupancy(batch);
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.resolution_m, kResolution_m);
  EXPECT_EQ(answer.points_occupied, (std::vector<bool>{true, false, false}));
  EXPECT_EQ(answer.boxes_occupied, (std::vector<bool>{false, true, false}));
  EXPECT_EQ(answer.spheres_occupied, (std::vector<bool>{false, true, false}));

  const auto near = [](const std::optional<double>& found, double true_m) {
    ASSERT_TRUE(found);
    EXPECT_LE(*found, true_m);  // conservative: never further than the truth
    EXPECT_GE(*found, true_m - kReach_m);
  };
  ASSERT_EQ(answer.rays_hit_m.size(), 3u);
  near(answer.rays_hit_m[0], 3.0);
  EXPECT_EQ(answer.rays_hit_m[1], std::nullopt);
  near(answer.rays_hit_m[2], 2.0);
  ASSERT_EQ(answer.distances_m.size(), 3u);
  near(answer.distances_m[0], 3.0);
  EXPECT_EQ(answer.distances_m[1], std::nullopt);
  near(answer.distances_m[2], 2.0);
  ASSERT_EQ(answer.sphere_paths_hit_m.size(), 2u);
  near(answer.sphere_paths_hit_m[0], 2.5);
  EXPECT_EQ(answer.sphere_paths_hit_m[1], std::nullopt);
}

TEST_F(OccupancyTest, AnswersABatchOfManyMessages) {
  OccupancyBatch batch;
  batch.scene = "cube";
  for (int i = 0; i < 20'000; ++i) {
    const double z = i % 2 == 0 ? 0.0 : 2.0;  // in the cube's bottom, in its empty middle
    batch.points_m.push_back({1.0 + i * 1e-4, 2.0, z});
  }
  Client client(patient());
  const OccupancyAnswer answer = client.occupancy(batch);
  ASSERT_TRUE(answer.ok()) << answer.error;
  ASSERT_EQ(answer.points_occupied.size(), batch.points_m.size());
  for (std::size_t i = 0; i < batch.points_m.size(); ++i) {
    ASSERT_EQ(answer.points_occupied[i], i % 2 == 0) << i;
  }
}

TEST_F(OccupancyTest, SaysThatASceneHasNoMap) {
  OccupancyBatch batch;
  batch.scene = "bare";
  batch.points_m.push_back({0, 0, 0});
  Client client(patient());
  const OccupancyAnswer answer = client.occupancy(batch);
  EXPECT_EQ(answer.status, Status::kNoMap);
  EXPECT_THAT(answer.error, HasSubstr("bare"));
}

}  // namespace
}  // namespace camway::integration
