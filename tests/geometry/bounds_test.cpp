// SPDX-License-Identifier: MIT
#include "daemon/geometry/bounds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace camway::geometry {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Bounds floor_at(double y_m) {
  Bounds bounds;
  bounds.min_W.y() = y_m;
  return bounds;
}

TEST(Bounds, AreNoneByDefault) {
  const Bounds none;
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.depth_m({1e9, -1e9, 0}), kInfinity);
  EXPECT_FALSE(fault_in(none));
  EXPECT_TRUE(floor_at(0.0).any());
}

TEST(Bounds, TellHowFarInsideAPointIs) {
  Bounds box{Vec3(0, 0, 0), Vec3(4, 3, 2)};
  EXPECT_EQ(box.depth_m({1, 1, 1.5}), 0.5);
  EXPECT_EQ(box.depth_m({-0.25, 1, 1.5}), -0.25);
  for (std::size_t side = 0; side < Bounds::kSides; ++side) {
    const Vec3 middle(2, 1.5, 1);
    const double depth_m = box.depth_m(side, middle);
    EXPECT_EQ(depth_m, middle[static_cast<int>(side % 3)]) << Bounds::kSideNames[side];
    // Against the inward direction until the point is on the side.
    EXPECT_EQ(box.depth_m(side, middle - depth_m * Bounds::inward(side)), 0.0);
    EXPECT_EQ(box.limit_m(side), side < 3 ? 0.0 : box.max_W[static_cast<int>(side - 3)]);
  }
}

TEST(Bounds, TogetherAreWhatBothAllow) {
  Bounds ceiling;
  ceiling.max_W.y() = 2.5;
  const Bounds storey = floor_at(0.0).within(ceiling);
  EXPECT_EQ(storey.min_W, Vec3(-kInfinity, 0, -kInfinity));
  EXPECT_EQ(storey.max_W, Vec3(kInfinity, 2.5, kInfinity));
  EXPECT_EQ(storey.within({}), storey);
  EXPECT_EQ(storey.shrunk_by(0.25).min_W.y(), 0.25);
  EXPECT_EQ(storey.shrunk_by(0.25).max_W.y(), 2.25);
  EXPECT_TRUE(fault_in(storey.within(floor_at(2.5))));
}

TEST(Bounds, FaultsNameTheSide) {
  Bounds bad = floor_at(std::nan(""));
  EXPECT_EQ(fault_in(bad)->field, "min[1]");
  bad = floor_at(-2e9);
  EXPECT_EQ(fault_in(bad)->field, "min[1]");
  bad = floor_at(kInfinity);
  EXPECT_EQ(fault_in(bad)->field, "min[1]");
  bad = {};
  bad.max_W.z() = std::nan("");
  EXPECT_EQ(fault_in(bad)->field, "max[2]");
  bad.max_W.z() = -kInfinity;
  EXPECT_EQ(fault_in(bad)->field, "min[2]");
}

}  // namespace
}  // namespace camway::geometry
