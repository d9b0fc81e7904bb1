// SPDX-License-Identifier: MIT
#include "daemon/planning/request/quaternion_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/random.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;

constexpr unsigned kOrderSeed = 1843;

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Quat about(const Vec3& axis, double angle_rad) { return Quat(Eigen::AngleAxisd(angle_rad, axis)); }

/// Returns the orientation of an upright camera in a scene with y or z up: heading about that axis,
/// then pitch, then roll.
Quat camera(const Vec3& up_W, double heading_rad, double pitch_rad, double roll_rad) {
  const Quat level = up_W.z() > 0.5 ? about(Vec3::UnitX(), std::numbers::pi / 2) : Quat::Identity();
  return about(up_W, heading_rad) * level * about(Vec3::UnitX(), pitch_rad) *
         about(Vec3::UnitZ(), roll_rad);
}

/// Returns a quaternion that was written x, y, z, w and read as w, x, y, z.
Quat misread(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

std::vector<motion::Keyframe> keyframes(const std::vector<Quat>& orientations) {
  std::vector<motion::Keyframe> list;
  for (const Quat& q : orientations) list.emplace_back().pose.orientation = q;
  return list;
}

TEST(QuaternionOrder, TellsWhatWasWrittenXyzwInScenesWithYUp) {
  EXPECT_TRUE(
      looks_like_other_order(keyframes({misread(Quat::Identity()), misread(Quat::Identity())})));
  testing::Random random(kOrderSeed);
  std::uniform_real_distribution<double> heading_deg(-80, 80);
  std::uniform_real_distribution<double> small_deg(-10, 10);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Quat> right;
    std::vector<Quat> wrong;
    for (int i = 0; i < 5; ++i) {
      right.push_back(camera(Vec3::UnitY(), radians(heading_deg(random)),
                             radians(small_deg(random)), radians(small_deg(random))));
      wrong.push_back(misread(right.back()));
    }
    EXPECT_FALSE(looks_like_other_order(keyframes(right))) << "trial " << trial;
    EXPECT_TRUE(looks_like_other_order(keyframes(wrong))) << "trial " << trial;
  }
}

// Only half of the headings can be recognised: for the others the cameras look upright as read,
// too.
TEST(QuaternionOrder, TellsWhatWasWrittenXyzwInScenesWithZUp) {
  testing::Random random(kOrderSeed);
  std::uniform_real_distribution<double> heading_deg(-150, -30);
  std::uniform_real_distribution<double> small_deg(-5, 5);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Quat> right;
    std::vector<Quat> wrong;
    for (int i = 0; i < 5; ++i) {
      right.push_back(camera(Vec3::UnitZ(), radians(heading_deg(random)),
                             radians(small_deg(random)), radians(small_deg(random))));
      wrong.push_back(misread(right.back()));
    }
    EXPECT_FALSE(looks_like_other_order(keyframes(right))) << "trial " << trial;
    EXPECT_TRUE(looks_like_other_order(keyframes(wrong))) << "trial " << trial;
  }
}

// Upright cameras in any direction, and cameras that are rolled on purpose.
TEST(QuaternionOrder, IsNotDoubtedWhereOneCameraIsUprightOrNoneIsInTheOtherOrder) {
  testing::Random random(kOrderSeed);
  std::uniform_real_distribution<double> heading(-std::numbers::pi, std::numbers::pi);
  std::uniform_real_distribution<double> pitch(-1.3, 1.3);
  for (const Vec3& up_W : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    for (int trial = 0; trial < 2000; ++trial) {
      std::vector<Quat> upright;
      for (int i = 0; i < 3; ++i) {
        upright.push_back(camera(up_W, heading(random), pitch(random), 0.0));
      }
      EXPECT_FALSE(looks_like_other_order(keyframes(upright)))
          << "trial " << trial << ", up " << up_W.transpose();
    }
  }
  const Quat rolled = camera(Vec3::UnitY(), 0.4, 0.1, radians(90));
  EXPECT_FALSE(looks_like_other_order(keyframes({rolled, rolled})));
  const Quat wrong = misread(Quat::Identity());
  EXPECT_FALSE(looks_like_other_order(keyframes({wrong, wrong, Quat::Identity()})));
}

TEST(QuaternionOrder, LengthAndSignDoNotMatter) {
  Quat wrong = misread(camera(Vec3::UnitY(), 0.5, 0.1, 0.0));
  wrong.coeffs() *= -7.0;
  EXPECT_TRUE(looks_like_other_order(keyframes({wrong, wrong})));
}

TEST(QuaternionOrder, TheWarningNamesTheFieldAsTheSenderDoes) {
  PlanRequest request;
  request.keyframes = keyframes({misread(Quat::Identity()), misread(Quat::Identity())});
  request.spelling = [](std::string_view path) { return "<" + std::string(path) + ">"; };
  EXPECT_THAT(*quaternion_order_warning(request),
              ::testing::StartsWith("<keyframes[].orientation>: "));
  request.keyframes[0].pose.orientation = Quat::Identity();
  EXPECT_FALSE(quaternion_order_warning(request));
}

TEST(QuaternionOrder, TellsWhatWasWrittenWxyzAndReadXyzw) {
  const Quat right = camera(Vec3::UnitY(), radians(40), 0, 0);
  const Quat wrong{right.z(), right.w(), right.x(), right.y()};  // its w was read as x
  PlanRequest request;
  request.keyframes = keyframes({wrong, wrong});
  EXPECT_TRUE(looks_like_other_order(request.keyframes, QuaternionOrder::kXyzw));
  EXPECT_FALSE(looks_like_other_order(keyframes({right, right}), QuaternionOrder::kXyzw));
  EXPECT_THAT(*quaternion_order_warning(request, QuaternionOrder::kXyzw),
              ::testing::HasSubstr("in the order w, x, y, z; they are read as x, y, z, w"));
}

}  // namespace
}  // namespace camway::planning
