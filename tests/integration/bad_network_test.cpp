// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

Pose at(double x_m, double y_m, double z_m) {
  Pose pose;
  pose.position_m = {x_m, y_m, z_m};
  return pose;
}

/// Scene and map requests of a client whose messages are lost, duplicated and delayed.
/// `load_test.cpp` and `watch_test.cpp` test planning and watching.
class BadNetworkTest : public IntegrationTest, public ::testing::WithParamInterface<double> {};

TEST_P(BadNetworkTest, ScenesAreUploadedChangedAndExportedAsOnAGoodOne) {
  start_daemon();
  start_bad_network(GetParam());
  Client far(patient_far_away());
  Client near(patient());

  const SceneAnswer loaded = far.load_scene("world", long_mesh(500'000), /*resolution=*/0.05);
  ASSERT_TRUE(loaded.ok()) << loaded.error;
  EXPECT_EQ(loaded.scene.num_triangles, 1);
  const SceneAnswer put = far.put_object("world", "crate", SceneBox{{4, 4, 4}}, at(5, 2, 20));
  ASSERT_TRUE(put.ok()) << put.error;
  constexpr int kMoves = 3;
  for (int i = 1; i <= kMoves; ++i) {
    const SceneAnswer moved = far.move_object("world", "crate", at(5, 2, 20.0 - i));
    ASSERT_TRUE(moved.ok()) << moved.error;
    EXPECT_EQ(moved.scene.revision, put.scene.revision + i) << "is made once, and not before";
  }

  const SceneMap truth = near.export_map("world");
  ASSERT_TRUE(truth.ok()) << truth.error;
  EXPECT_GT(truth.bytes.size(), 48'000U) << "several pages";
  const SceneMap map = far.export_map("world");
  ASSERT_TRUE(map.ok()) << map.error;
  EXPECT_EQ(map.bytes, truth.bytes);

  OccupancyBatch batch;
  batch.scene = "world";
  for (int i = 0; i < 5000; ++i) batch.points_m.push_back({5.0, 2.0, 0.005 * i});
  const OccupancyAnswer known = near.occupancy(batch);
  ASSERT_TRUE(known.ok()) << known.error;
  const OccupancyAnswer occupied = far.occupancy(batch);
  ASSERT_TRUE(occupied.ok()) << occupied.error;
  EXPECT_EQ(occupied.points_occupied, known.points_occupied);
}

INSTANTIATE_TEST_SUITE_P(Shares, BadNetworkTest, ::testing::ValuesIn(kBadShares), name_of_share);

}  // namespace
}  // namespace camway::integration
