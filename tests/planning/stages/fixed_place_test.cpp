// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/fixed_place.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/stages/path_check.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using correction::CorrectionKind;
using geometry::Quat;
using motion::Keyframe;
using motion::KeyframeOrigin;

constexpr double kGap_m = 0.05;

/// A camera that flies straight along -z at 1 m/s, past thin posts at its right.
class LimitingPlace : public ::testing::Test {
 protected:
  LimitingPlace() {
    result_.keyframes = {{0.0, {{0, 0, 2}, Quat::Identity()}},
                         {1.0, {{0, 0, 1}, Quat::Identity()}, KeyframeOrigin::kInserted},
                         {2.0, {{0, 0, 0}, Quat::Identity()}},
                         {4.0, {{0, 0, -2}, Quat::Identity()}}};
    result_.path = motion::interpolate(result_.keyframes);
  }

  /// Adds a post that the camera passes at a time, at a distance.
  void add_post(double time_s, double gap_m) {
    const double x = motion::near_corners_C(camera_)[0].x() + gap_m;
    const double z = 2.0 - time_s - camera_.near_m;
    testing::add_cuboid(mesh_, {x, -1, z - 0.001}, {x + 0.01, 1, z + 0.001});
  }

  void correct(double t_begin_s, double t_end_s, CorrectionKind kind = CorrectionKind::kMove) {
    correction::Correction& correction = result_.corrections.emplace_back();
    correction.kind = kind;
    correction.t_begin_s = t_begin_s;
    correction.t_end_s = t_end_s;
  }

  std::optional<FixedPlace> place(const Deadline& deadline = Deadline::never()) {
    const scene::SceneIndex index = scene::SceneIndex::build(mesh_);
    const collision::Query query{collision::Obstacles(index), motion::Body(camera_)};
    result_.certificate = certificate_of_free(query, result_.path, Deadline::never());
    return limiting_place(query, result_, deadline);
  }

  const motion::Camera camera_ = testing::small_camera();
  scene::Mesh mesh_;
  PlanResult result_;
};

TEST_F(LimitingPlace, IsTheGivenKeyframeThatIsNearest) {
  add_post(2.0, kGap_m);
  add_post(3.0, 1.1 * kGap_m);
  correct(0.0, 4.0);
  const auto found = place();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframe, 1U) << "inserted ones have no number";
  EXPECT_NEAR(found->distance_m, kGap_m, 0.01 * kGap_m);
}

TEST_F(LimitingPlace, IsAKeyframeThatLeavesLittleMore) {
  add_post(2.0, 1.15 * kGap_m);
  add_post(3.0, kGap_m);
  correct(0.0, 4.0);
  EXPECT_EQ(place().value().keyframe, 1U);
}

TEST_F(LimitingPlace, IsAnInstantThatNothingChanged) {
  add_post(3.0, kGap_m);
  add_post(1.5, 1.5 * kGap_m);
  correct(0.0, 2.0);
  correct(2.0, 4.0, CorrectionKind::kNone);
  const auto found = place();
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->keyframe);
  EXPECT_NEAR(found->time_s, 3.0, 0.5 * kGap_m);
}

// The distances of the whole path and of a part of it are measured at different times.
TEST_F(LimitingPlace, IsFoundWhereverThePathIsNearest) {
  testing::Random random(2291);
  correct(0.0, 2.0);
  for (int run = 0; run < 100; ++run) {
    mesh_ = {};
    const double time_s = random.uniform(2.3, 3.7);
    const double gap_m = random.uniform(0.2, 1.0) * kGap_m;
    add_post(time_s, gap_m);
    add_post(1.5, random.uniform(1.3, 2.0) * gap_m);
    const auto found = place();
    ASSERT_TRUE(found) << "run " << run;
    EXPECT_NEAR(found->time_s, time_s, gap_m) << "run " << run;
  }
}

TEST_F(LimitingPlace, IsNoneWhereACorrectionIsNearest) {
  add_post(1.5, kGap_m);
  add_post(3.0, 1.5 * kGap_m);
  correct(0.0, 2.0);
  EXPECT_FALSE(place());
}

TEST_F(LimitingPlace, IsUnknownAfterTheDeadline) {
  add_post(2.0, kGap_m);
  EXPECT_FALSE(place(Deadline::after_s(0.0)));
}

}  // namespace
}  // namespace camway::planning
