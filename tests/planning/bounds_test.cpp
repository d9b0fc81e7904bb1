// SPDX-License-Identifier: MIT
//
// Plans that must stay within bounds, of the request or of the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/stages/path_outside_bounds.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/scene_difference.h"
#include "tests/planning/plan_fixture.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using geometry::Bounds;
using geometry::Quat;
using geometry::Vec3;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_plan::planned;

constexpr int kSamples = 5000;

std::shared_ptr<const scene::Snapshot> house_of(scene::Mesh mesh, const Bounds& bounds = {}) {
  scene::SnapshotOptions options;
  options.bounds = bounds;
  return scene::make_snapshot("house", std::move(mesh), options).snapshot;
}

/// Returns a strip of floor and a wall across it that ends at z = 2. The way under the floor is
/// shorter than the one around the end of the wall.
scene::Mesh house() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.6, -0.2, -4}, {0.6, 0.0, 4});
  testing::add_cuboid(mesh, {-0.05, 0.0, -4}, {0.05, 2.5, 2});
  return mesh;
}

Bounds inside_the_house() { return {Vec3(-4, -0.05, -4), Vec3(4, 2.5, 4)}; }

PlanRequest across_the_wall() {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  const Quat along = testing::looking_along({1, 0, 0});
  request.keyframes = {{0.0, {{-1.5, 0.5, 0}, along}}, {4.0, {{1.5, 0.5, 0}, along}}};
  return request;
}

/// Returns the least depth of a corner within `bounds`, over samples of the path.
double least_depth_m(const PlanResult& result, const motion::Camera& camera, const Bounds& bounds) {
  double least_m = std::numeric_limits<double>::infinity();
  const motion::Path& path = result.path;
  for (int i = 0; i <= kSamples; ++i) {
    const double time_s = std::lerp(path.begin_s(), path.end_s(), double(i) / kSamples);
    for (const Vec3& corner_W :
         motion::corners_W(motion::near_corners_C(camera), path.pose(time_s)))
      least_m = std::min(least_m, bounds.depth_m(corner_W));
  }
  return least_m;
}

TEST(PlanWithinBounds, GoesRoundTheWallInsteadOfUnderTheFloor) {
  const auto snapshot = house_of(house());
  PlanRequest request = across_the_wall();
  const PlanResult under = planned(*snapshot, request);
  ASSERT_EQ(under.status, Status::kOk) << under.message;
  EXPECT_LT(least_depth_m(under, request.camera, inside_the_house()), -0.1)
      << "no need for bounds: it does not dive under the floor";
  EXPECT_FALSE(under.bounds.any());

  request.options.bounds = inside_the_house();
  const PlanResult within = planned(*snapshot, request);
  ASSERT_EQ(within.status, Status::kOk) << within.message;
  EXPECT_TRUE(within.certificate.certified);
  EXPECT_GT(least_depth_m(within, request.camera, inside_the_house()), 0.0);
  EXPECT_EQ(within.bounds, inside_the_house());
  EXPECT_THAT(within.message, HasSubstr("within bounds"));
}

// One limit is enough, and the scene's bounds have the same effect as the request's.
TEST(PlanWithinBounds, OfTheSceneOrOfTheRequestAreTheSame) {
  Bounds floor;
  floor.min_W.y() = -0.05;
  PlanRequest request = across_the_wall();
  const PlanResult by_scene = planned(*house_of(house(), floor), request);
  request.options.bounds = floor;
  const PlanResult by_request = planned(*house_of(house()), request);
  ASSERT_EQ(by_scene.status, Status::kOk) << by_scene.message;
  EXPECT_GT(least_depth_m(by_scene, request.camera, floor), 0.0);
  ASSERT_EQ(by_scene.path.segments().size(), by_request.path.segments().size());
  for (std::size_t i = 0; i < by_scene.path.segments().size(); ++i) {
    EXPECT_EQ(by_scene.path.segments()[i].position, by_request.path.segments()[i].position);
    EXPECT_EQ(by_scene.path.segments()[i].orientation, by_request.path.segments()[i].orientation);
  }
  EXPECT_EQ(by_scene.bounds, by_request.bounds);
  EXPECT_EQ(by_scene.message, by_request.message);
}

TEST(PlanWithinBounds, SaysWhereTheOnlyWayLeadsBeyondThem) {
  PlanRequest request = across_the_wall();
  Bounds shut = inside_the_house();
  shut.max_W.z() = 1.9;  // the wall ends beyond
  request.options.bounds = shut;
  request.options.orientation.rule = correction::OrientationRule::kKeep;  // fails sooner
  const PlanResult result = planned(*house_of(house()), request);
  EXPECT_EQ(result.status, Status::kPartial);
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_THAT(result.message, HasSubstr("a way was found only beyond the bounds, by up to"));
  EXPECT_THAT(result.message, HasSubstr("at min.y")) << "under the floor";
  // A way beyond the bounds is reported even if the deadline came during the search within them.
  EXPECT_TRUE(may_have_path_outside_bounds(request, result));
  PlanResult late = result;
  late.status = Status::kTimeout;
  EXPECT_TRUE(may_have_path_outside_bounds(request, late));
  // Without corrections there was no search for a way within the bounds.
  request.options.max_inserted_keyframes = 0;
  EXPECT_THAT(planned(*house_of(house()), request).message, Not(HasSubstr("beyond the bounds")));
}

// A way within the bounds that needs a keyframe too many is no reason to look beyond them.
TEST(PlanWithinBounds, SaysNothingOfThemWhereTheLimitOfKeyframesIsTheReason) {
  const auto snapshot = house_of(house());
  PlanRequest request = across_the_wall();
  request.options.bounds = inside_the_house();
  const PlanResult within = planned(*snapshot, request);
  ASSERT_EQ(within.status, Status::kOk) << within.message;
  const auto inserted =
      static_cast<std::int32_t>(within.keyframes.size() - request.keyframes.size());
  ASSERT_GT(inserted, 1);
  request.options.max_inserted_keyframes = inserted - 1;
  const PlanResult refused = planned(*snapshot, request);
  EXPECT_EQ(refused.status, Status::kPartial);
  EXPECT_THAT(refused.message, HasSubstr("the corrections that were found need"));
  EXPECT_THAT(refused.message, Not(HasSubstr("beyond the bounds")));
}

// A room without a door: bounds do not change the proof.
TEST(PlanWithinBounds, LeavesProofsOfInfeasibilityAsTheyAre) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {0.5, -1, -1}, {2.5, 1.5, 1});
  PlanRequest request = across_the_wall();
  const PlanResult without = planned(*house_of(mesh), request);
  ASSERT_EQ(without.status, Status::kInfeasible) << without.message;
  request.options.bounds = {Vec3(-4, -4, -4), Vec3(4, 4, 4)};
  const PlanResult with = planned(*house_of(mesh), request);
  EXPECT_EQ(with.status, Status::kInfeasible);
  EXPECT_EQ(with.infeasibility->triangles, without.infeasibility->triangles);
}

TEST(PlanWithinBounds, BringsBackWhatInterpolationTakesBeyondThem) {
  PlanRequest request = across_the_wall();
  request.keyframes[0].time_s = 0.0;
  const Quat ahead = Quat::Identity();
  request.keyframes = {{0.0, {{-2, 0, 0}, ahead}},
                       {1.0, {{-0.2, 0.9, 0}, ahead}},
                       {2.0, {{0.2, 0.9, 0}, ahead}},
                       {3.0, {{2, 0, 0}, ahead}}};
  request.options.bounds.max_W.y() = 1.0;
  const auto nothing = house_of({});
  PlanResult result = planned(*nothing, request);
  ASSERT_EQ(result.status, Status::kOk) << result.message;
  ASSERT_FALSE(result.collisions.empty()) << "it does not overshoot";
  EXPECT_GT(least_depth_m(result, request.camera, request.options.bounds), 0.0);
  name_witnesses(nothing->mesh, request, result);
  EXPECT_EQ(result.collision_names.front().object, "bounds.max.y");
  EXPECT_THAT(result.collision_names.front().feature, HasSubstr("corner"));
}

TEST(PlanWithinBounds, KeyframesBeyondThemAreNamedWithTheNearestPoseInside) {
  PlanRequest request = across_the_wall();
  request.options.bounds.max_W.x() = 1.0;
  const PlanResult refused = planned(*house_of({}), request);
  EXPECT_EQ(refused.status, Status::kInvalid);
  EXPECT_EQ(refused.keyframe, 1u);
  EXPECT_THAT(refused.message, HasSubstr("keyframes[1]: the near quadrilateral leaves the bounds"));
  ASSERT_EQ(refused.keyframe_faults.size(), 1u);
  const KeyframeFault& fault = refused.keyframe_faults.front();
  // The camera looks along x: the whole quadrilateral is 0.1 m in front of the eye.
  EXPECT_NEAR(fault.depth_m, 0.6, 1e-12);
  ASSERT_TRUE(fault.free_pose);
  EXPECT_NEAR(fault.free_pose->position.x(), 0.9, 0.02);
  EXPECT_EQ(fault.free_pose->position.y(), 0.5);

  request.options.repair_keyframes = true;
  const PlanResult repaired = planned(*house_of({}), request);
  EXPECT_EQ(repaired.status, Status::kOk) << repaired.message;
  EXPECT_GT(least_depth_m(repaired, request.camera, request.options.bounds), 0.0);
}

TEST(PlanWithinBounds, RefusesThoseThatLeaveNoRoom) {
  PlanRequest request = across_the_wall();
  request.options.bounds.min_W.x() = 1.0;
  request.options.bounds.max_W.x() = 1.0;
  EXPECT_THAT(planned(*house_of({}), request).message, HasSubstr("options.bounds.min[0]"));
  request.options.bounds.max_W.x() = 2.0;
  Bounds elsewhere;
  elsewhere.max_W.x() = 0.5;
  const PlanResult result = planned(*house_of({}, elsewhere), request);
  EXPECT_EQ(result.status, Status::kInvalid);
  EXPECT_THAT(result.message, HasSubstr("no room within the bounds of the scene"));
}

// Bounds that nothing comes near change no number.
TEST(PlanWithinBounds, ThatAreFarAwayLeaveFreePathsAsTheyAre) {
  PlanRequest request = across_the_wall();
  const auto nothing = house_of({});
  const PlanResult without = planned(*nothing, request);
  request.options.bounds = {Vec3(-50, -50, -50), Vec3(50, 50, 50)};
  const PlanResult with = planned(*nothing, request);
  ASSERT_EQ(with.status, Status::kOk);
  EXPECT_EQ(with.path.segments().front().position, without.path.segments().front().position);
  EXPECT_EQ(with.certificate.clearance_lower_bound_m, without.certificate.clearance_lower_bound_m);
}

// Every ok path is inside its bounds at every sample, and is proved so again.
TEST(PlanWithinBounds, NoProvedPathLeavesThem) {
  testing::Random random(19);
  std::uniform_real_distribution<double> place(-0.75, 0.75);
  const Bounds bounds{Vec3(-0.86, -0.86, -0.86), Vec3(0.86, 0.86, 0.86)};
  int proved = 0;
  int corrected = 0;
  for (int run = 0; run < 36; ++run) {
    const auto snapshot = house_of(testing::scattered_triangles(random, 25, 0.2));
    PlanRequest request;
    request.camera = testing::small_camera();
    request.has_times = true;
    request.options.repair_keyframes = true;
    request.options.objective = static_cast<correction::Objective>(run % 4);
    request.options.bounds = bounds;
    for (int i = 0; i < 5; ++i) {
      request.keyframes.push_back(
          {static_cast<double>(i),
           {{place(random), place(random), place(random)}, random.rotation()}});
    }
    const PlanResult result = planned(*snapshot, request);
    if (result.status != Status::kOk) continue;
    ++proved;
    const bool left = std::ranges::any_of(result.collisions, [](const auto& interval) {
      return interval.witness && collision::Obstacles::is_side(interval.witness->triangle);
    });
    corrected += left ? 1 : 0;
    EXPECT_GT(least_depth_m(result, request.camera, bounds), 0.0) << "run " << run;
    const motion::Body body(request.camera);
    const PathCheck check = check_path(
        {collision::Obstacles(*snapshot).within(bounds), body, detect_options(request.options)},
        result.path, base::Deadline::never(), base::Deadline::never());
    EXPECT_TRUE(check.certificate.certified) << "run " << run;
  }
  EXPECT_GT(proved, 10);
  EXPECT_GT(corrected, 4);
}

TEST(WatchedPathWithinBounds, IsCheckedAnewWhereTheSceneHasOthers) {
  PlanRequest request = across_the_wall();
  request.options.bounds.max_W.y() = 2.0;
  const auto before = house_of({});
  const PlanResult result = planned(*before, request);
  const auto watched = WatchedPath::of(request, result);
  ASSERT_TRUE(watched);
  EXPECT_TRUE(watched->collisions(collision::Obstacles(*before), base::Deadline::never()).empty());
  Bounds low;
  low.max_W.y() = 0.4;
  const auto after = house_of({}, low);
  const scene::SceneDifference change = scene::difference(*before, *after);
  EXPECT_FALSE(change.empty());
  EXPECT_TRUE(watched->may_meet(change));
  EXPECT_FALSE(watched->stays_free(change, base::Deadline::never()));
  EXPECT_EQ(watched->collisions(collision::Obstacles(*after), base::Deadline::never()).size(), 1u);
  EXPECT_TRUE(scene::difference(*before, *house_of({})).empty());
}

}  // namespace
}  // namespace camway::planning
