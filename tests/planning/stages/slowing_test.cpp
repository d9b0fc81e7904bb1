// SPDX-License-Identifier: MIT
// Motion limits end to end: a slowed path meets its limits and keeps its curve.
#include "daemon/planning/stages/slowing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/correction/path/orientation_rule.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/motion/timing/retimed_path.h"
#include "daemon/planning/plan.h"
#include "daemon/planning/stages/path_check.h"
#include "tests/motion/smooth_joins.h"
#include "tests/planning/plan_fixture.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_plan::planned;

// Returns a column that the tour below grazes.
std::shared_ptr<const scene::Snapshot> grazed_column() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {0.31, -3, -0.2}, {0.5, 3, 0.0});
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

PlanRequest bulging_tour() {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  request.keyframes = {{0.0, {{0, 0, 2}, Quat::Identity()}},
                       {2.0, {{0.25, 0, 0.4}, Quat::Identity()}},
                       {4.0, {{0, 0, -2}, Quat::Identity()}},
                       {6.0, {{-1, 0, -2}, Quat(Eigen::AngleAxisd(1.5, Vec3::UnitY()))}}};
  return request;
}

/// Adds limits that the answer without limits breaks at some places.
PlanRequest limited(PlanRequest request, double share) {
  const PlanResult free = planned(*grazed_column(), request);
  EXPECT_EQ(free.status, Status::kOk) << free.message;
  request.options.limits.speed_m_per_s = share * free.measures->largest_speed_m_per_s;
  request.options.limits.acceleration_m_per_s2 =
      share * free.measures->largest_acceleration_m_per_s2;
  request.options.limits.turn_rate_rad_per_s = share * free.measures->largest_turn_rate_rad_per_s;
  return request;
}

PlanRequest retimed(PlanRequest request) {
  request.options.limits.may_retime = true;
  return request;
}

TEST(Limits, AreNamedWithTheTimeWhereTheyAreBroken) {
  PlanRequest request = bulging_tour();
  request.options.limits.turn_rate_rad_per_s = 0.5;
  const PlanResult refused = planned(*grazed_column(), request);
  EXPECT_EQ(refused.status, Status::kPartial);
  EXPECT_THAT(refused.message, HasSubstr("options.limits: the path is free, but too fast from"));
  EXPECT_THAT(refused.message, HasSubstr("turn rate"));
  EXPECT_THAT(refused.message, HasSubstr("28.6 degrees/s"));
  // The proofs for the path remain true.
  EXPECT_TRUE(refused.certificate.certified);
  EXPECT_TRUE(refused.remaining_collisions.empty());
  EXPECT_EQ(refused.time_scale, 1.0);
}

TEST(Limits, OfAPathThatMeetsThemChangeNothing) {
  const PlanResult free = planned(*grazed_column(), bulging_tour());
  const PlanResult same = planned(*grazed_column(), retimed(limited(bulging_tour(), 1.01)));
  EXPECT_EQ(same.message, free.message);
  EXPECT_EQ(same.time_scale, 1.0);
  EXPECT_EQ(same.path.end_s(), free.path.end_s());
}

TEST(Limits, SlowThePathWhereItIsTooFastAndKeepItsProof) {
  for (const double share : {0.9, 0.7, 0.3}) {
    SCOPED_TRACE(::testing::Message() << "share " << share);
    const PlanRequest request = retimed(limited(bulging_tour(), share));
    const auto snapshot = grazed_column();
    const PlanResult slower = planned(*snapshot, request);
    ASSERT_EQ(slower.status, Status::kOk) << slower.message;
    const SlowedStretch& first = slower.slowed.at(0);
    const bool is_all = first.given_t_end_s - first.given_t_begin_s == 6.0;
    EXPECT_THAT(slower.message, HasSubstr(is_all ? "slowed all the way" : "slowed in part"));
    EXPECT_EQ(is_all, share < 0.5) << "both are tried";
    EXPECT_TRUE(motion::meets(slower.path, request.options.limits));
    EXPECT_GT(slower.time_scale, 1.0);
    EXPECT_LT(slower.time_scale, 0.97 / share) << "than all the way";
    EXPECT_NEAR(slower.path.end_s(), 6.0 * slower.time_scale, 1e-12);
    ASSERT_FALSE(slower.slowed.empty());
    double lost_s = 0.0;
    for (const SlowedStretch& stretch : slower.slowed) {
      // The part before it is shifted by the time lost so far, and keeps its duration.
      EXPECT_NEAR(stretch.t_begin_s - stretch.given_t_begin_s, lost_s, 1e-12);
      lost_s = stretch.t_end_s - stretch.given_t_end_s;
    }
    EXPECT_NEAR(slower.path.end_s() - 6.0, lost_s, 1e-12);
    motion::test::expect_smooth(slower.path, 8.0);
    // The path is proved again by code that does not know how it was made.
    const auto body = motion::Body::make(request.camera);
    const PathCheck check = check_path({collision::Obstacles(*snapshot), *body}, slower.path,
                                       base::Deadline::never(), base::Deadline::never());
    EXPECT_TRUE(check.certificate.certified);
    EXPECT_EQ(slower.certificate.clearance_lower_bound_m,
              check.certificate.clearance_lower_bound_m);
  }
}

TEST(Limits, KeyframesAndIntervalsMoveToTheNewTimes) {
  const PlanRequest request = limited(bulging_tour(), 0.7);
  const PlanResult before = planned(*grazed_column(), request);
  const PlanResult after = planned(*grazed_column(), retimed(request));
  ASSERT_EQ(after.keyframes.size(), before.keyframes.size());
  for (std::size_t i = 0; i < after.keyframes.size(); ++i) {
    const motion::Keyframe& is = after.keyframes[i];
    const motion::Keyframe& was = before.keyframes[i];
    EXPECT_GE(is.time_s, was.time_s);
    const motion::Pose pose = after.path.pose(is.time_s);
    EXPECT_EQ(pose.position, is.pose.position);
    EXPECT_LT(pose.orientation.angularDistance(is.pose.orientation), 1e-12);
    EXPECT_LT((is.pose.position - was.pose.position).norm(), 1e-3);
    if (was.origin == motion::KeyframeOrigin::kGiven) {
      EXPECT_EQ(is.pose.position, was.pose.position);
    }
  }
  // Collision and correction are at the same places of the path as before.
  ASSERT_EQ(after.collisions.size(), 1U);
  ASSERT_EQ(after.corrections.size(), 1U);
  const auto position = [](const PlanResult& result, double time_s) {
    return result.path.pose(time_s).position;
  };
  const auto expect_same_place = [&](double after_s, double before_s) {
    EXPECT_LT((position(after, after_s) - position(before, before_s)).norm(), 1e-3);
  };
  expect_same_place(after.collisions[0].t_begin_s, before.collisions[0].t_begin_s);
  expect_same_place(after.collisions[0].t_end_s, before.collisions[0].t_end_s);
  expect_same_place(after.corrections[0].t_begin_s, before.corrections[0].t_begin_s);
  expect_same_place(after.corrections[0].t_end_s, before.corrections[0].t_end_s);
  ASSERT_TRUE(after.collisions[0].witness);
  expect_same_place(after.collisions[0].witness->time_s, before.collisions[0].witness->time_s);
  // Compared with the interpolated path at the same place, not at the same fraction of the time.
  EXPECT_NEAR(after.measures->largest_deviation_m, before.measures->largest_deviation_m, 1e-3);
}

TEST(Limits, AreMetWhereTimesAreDerived) {
  PlanRequest request = bulging_tour();
  request.has_times = false;
  request = retimed(limited(request, 0.6));
  const PlanResult slower = planned(*grazed_column(), request);
  EXPECT_EQ(slower.status, Status::kOk) << slower.message;
  EXPECT_TRUE(motion::meets(slower.path, request.options.limits));
}

TEST(Limits, OrientationPoliciesAreKept) {
  PlanRequest request = bulging_tour();
  request.options.orientation.rule = correction::OrientationRule::kLevel;
  request.options.orientation.max_turn_rad = 0.3;
  request = retimed(limited(request, 0.6));
  const PlanResult slower = planned(*grazed_column(), request);
  ASSERT_EQ(slower.status, Status::kOk) << slower.message;
  EXPECT_THAT(slower.message, HasSubstr("slowed in part"));
  EXPECT_TRUE(motion::meets(slower.path, request.options.limits));
}

TEST(Limits, StretchAllTimesOfAPathThatCollides) {
  PlanRequest request = bulging_tour();
  request.options.max_inserted_keyframes = 0;
  const PlanResult before = planned(*grazed_column(), request);
  ASSERT_EQ(before.status, Status::kPartial);
  request.options.limits.speed_m_per_s = 0.5 * before.measures->largest_speed_m_per_s;
  const PlanResult after = planned(*grazed_column(), retimed(request));
  EXPECT_EQ(after.status, Status::kPartial);
  EXPECT_THAT(after.message, HasSubstr("slowed all the way"));
  EXPECT_NEAR(after.time_scale, 2.0, 0.01);
  EXPECT_TRUE(motion::meets(after.path, request.options.limits));
  ASSERT_EQ(after.path.segments().size(), before.path.segments().size());
  for (std::size_t i = 0; i < after.path.segments().size(); ++i)
    EXPECT_EQ(after.path.segments()[i].position, before.path.segments()[i].position);
  ASSERT_FALSE(after.remaining_collisions.empty());
  EXPECT_NEAR(after.remaining_collisions[0].t_begin_s,
              after.time_scale * before.remaining_collisions[0].t_begin_s, 1e-9);
}

TEST(Limits, WithoutTimeForAnotherCurveAllTimesAreStretched) {
  const PlanRequest request = limited(bulging_tour(), 0.7);
  const auto snapshot = grazed_column();
  const auto body = motion::Body::make(request.camera);
  const motion::CubicPath path = motion::interpolate_cubic(request.keyframes);
  const collision::Query query{collision::Obstacles(*snapshot), *body};
  const motion::TimeOrigin origin;
  const std::vector<double> keyframes_s = {0.0, 2.0, 4.0, 6.0};
  const TooFast problem{path,
                        path,
                        request.options.limits,
                        request.options.orientation,
                        query,
                        origin,
                        keyframes_s,
                        /*is_free=*/true};
  EXPECT_FALSE(slowed_where_needed(problem, base::Deadline::after_s(0.0)));
  EXPECT_FALSE(slowed_uniformly(problem, base::Deadline::after_s(0.0)));
  const std::optional<Retimed> slowed = slowed_uniformly(problem, base::Deadline::never());
  ASSERT_TRUE(slowed);
  EXPECT_TRUE(motion::meets(slowed->path.path(), request.options.limits));
  EXPECT_FALSE(slowed->check);
  for (std::size_t i = 0; i < path.pieces.size(); ++i)
    EXPECT_EQ(slowed->path.pieces[i].position, path.pieces[i].position);
}

TEST(Limits, TheSameRequestGivesTheSameBits) {
  const PlanRequest request = retimed(limited(bulging_tour(), 0.7));
  const PlanResult a = planned(*grazed_column(), request);
  const PlanResult b = planned(*grazed_column(), request);
  EXPECT_EQ(a.time_scale, b.time_scale);
  ASSERT_EQ(a.path.segments().size(), b.path.segments().size());
  for (std::size_t i = 0; i < a.path.segments().size(); ++i) {
    EXPECT_EQ(a.path.segments()[i].t1_s, b.path.segments()[i].t1_s);
    EXPECT_EQ(a.path.segments()[i].position, b.path.segments()[i].position);
    EXPECT_EQ(a.path.segments()[i].orientation, b.path.segments()[i].orientation);
  }
}

TEST(Limits, TheWorstPartIsFoundAndTheOthersCounted) {
  const std::vector<motion::Keyframe> keyframes = {{0.0, {{0, 0, 0}, Quat::Identity()}},
                                                   {1.0, {{1, 0, 0}, Quat::Identity()}},
                                                   {2.0, {{1.2, 0, 0}, Quat::Identity()}},
                                                   {3.0, {{3, 0, 0}, Quat::Identity()}}};
  const motion::Path path = motion::interpolate(keyframes);
  const auto breach = find_limit_breach(path, {.speed_m_per_s = 0.9});
  ASSERT_TRUE(breach);
  EXPECT_EQ(breach->parts, 2U);
  EXPECT_GT(breach->t_begin_s, 2.0);
  EXPECT_EQ(breach->t_end_s, 3.0);
  EXPECT_THAT(breach->rate, HasSubstr("its speed is up to 2."));
  EXPECT_THAT(breach->rate, HasSubstr("of 0.9 m/s"));
  EXPECT_FALSE(find_limit_breach(path, {.speed_m_per_s = 3.0}));
}

}  // namespace
}  // namespace camway::planning
