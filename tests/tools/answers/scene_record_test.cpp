// SPDX-License-Identifier: MIT
#include "tools/answers/scene_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using scene::VerticalAxis;

/// Level cameras of all headings, a little tilted, where y points up; or where z does.
planning::PlanRequest tour(VerticalAxis up, double tilt_rad) {
  planning::PlanRequest request;
  const Quat stands = up == VerticalAxis::kY
                          ? Quat::Identity()
                          : Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  for (int i = 0; i < 7; ++i) {
    motion::Keyframe keyframe;
    keyframe.pose.orientation = stands * Quat(Eigen::AngleAxisd(0.9 * i, Vec3::UnitY())) *
                                Quat(Eigen::AngleAxisd(tilt_rad, Vec3::UnitX()));
    request.keyframes.push_back(keyframe);
  }
  return request;
}

TEST(SceneRecord, CamerasShowTheAxisThatPointsUp) {
  for (const double tilt_rad : {-0.7, -0.2, 0.0, 0.5}) {
    for (const VerticalAxis up : {VerticalAxis::kY, VerticalAxis::kZ}) {
      EXPECT_EQ(vertical_axis(std::nullopt, tour(up, tilt_rad)), up) << tilt_rad;
      EXPECT_EQ(vertical_axis(scene::UpAxis::kAsInFile, tour(up, tilt_rad)), up) << tilt_rad;
    }
  }
  EXPECT_EQ(vertical_axis(std::nullopt, {}), VerticalAxis::kY);
}

TEST(SceneRecord, TurnedAxesCountMostThenTheLevelPolicy) {
  planning::PlanRequest request = tour(VerticalAxis::kY, 0.0);
  EXPECT_EQ(vertical_axis(scene::UpAxis::kYToZ, request), VerticalAxis::kZ);
  request.options.orientation.up_W = Vec3::UnitZ();
  EXPECT_EQ(vertical_axis({}, request), VerticalAxis::kY) << "the policy is not level";
  request.options.orientation.rule = correction::OrientationRule::kLevel;
  EXPECT_EQ(vertical_axis({}, request), VerticalAxis::kZ);
  EXPECT_EQ(vertical_axis(scene::UpAxis::kZToY, request), VerticalAxis::kY);
}

/// The frame of a robot may have any axis up, so its keyframes show nothing; all else still counts.
TEST(SceneRecord, OtherBodiesDoNotShowTheAxis) {
  planning::PlanRequest request = tour(VerticalAxis::kY, 0.0);
  request.body = motion::Camera{};
  EXPECT_EQ(vertical_axis(std::nullopt, request), VerticalAxis::kY);
  request.body = motion::BoxShape{};
  EXPECT_EQ(vertical_axis(std::nullopt, request), std::nullopt);
  EXPECT_EQ(vertical_axis(scene::UpAxis::kYToZ, request), VerticalAxis::kZ);
  request.options.orientation = {.rule = correction::OrientationRule::kLevel,
                                 .up_W = Vec3::UnitZ()};
  EXPECT_EQ(vertical_axis(std::nullopt, request), VerticalAxis::kZ);
}

TEST(SceneRecord, SaysThatAPathIsOfAnotherScene) {
  EXPECT_EQ(another_scene("P.json", "", "office.obj", "11"), "");
  EXPECT_EQ(another_scene("P.json", "11", "office.obj", "11"), "");
  EXPECT_EQ(another_scene("P.json", "22", "office.obj", "11"),
            "P.json: was made for another scene: its scene_digest is 22, that of office.obj is 11");
}

}  // namespace
}  // namespace camway::tools
