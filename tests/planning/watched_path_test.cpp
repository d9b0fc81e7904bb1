// SPDX-License-Identifier: MIT
#include "daemon/planning/watched_path.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/voxels/voxel_map.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/watched_scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using scene::SceneChange;
using testing::at;
using testing::box_source;
using testing::random_path_request;

Vec3 place_on(const motion::Path& path, testing::Random& random) {
  const double time_s =
      std::uniform_real_distribution<double>(path.begin_s(), path.end_s())(random);
  return path.pose(time_s).position;
}

std::vector<collision::CollisionInterval> from_scratch(const scene::Snapshot& snapshot,
                                                       const WatchedPath& watched,
                                                       const motion::Body& body) {
  const auto found = collision::detect_collisions(
      {collision::Obstacles(snapshot), body, detect_options(PlanOptions{})}, watched.path(),
      watched.path().begin_s(), watched.path().end_s(), Deadline::never());
  return *found;
}

TEST(WatchedPath, SaysWhatCheckingFromScratchSays) {
  testing::Random random(7351);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::uniform_real_distribution<double> size(0.05, 1.5);
  scene::SceneStore store;
  store.put(scene::assemble("room", 1, {}, {}));
  for (const char* const name : {"a", "b", "c", "d", "e"}) {
    store.change("room",
                 {SceneChange::Kind::kPut, name,
                  box_source({size(random), size(random), size(random)}), at({20, 20, 20})});
  }
  int broken = 0;
  int unharmed = 0;
  int proved = 0;
  for (int round = 0; round < 400; ++round) {
    const auto before = store.find("room");
    const PlanRequest request = random_path_request(3 + random() % 4, random);
    const PlanResult planned = plan(*before, request);
    const std::optional<WatchedPath> watched = WatchedPath::of(request, planned);
    ASSERT_EQ(watched.has_value(), planned.certificate.certified);
    const std::string name(1, static_cast<char>('a' + random() % 5));
    const Vec3 offset(place(random), place(random), place(random));
    const Vec3 to =
        watched && round % 2 == 0 ? place_on(watched->path(), random) + 0.2 * offset : offset;
    store.change("room", {SceneChange::Kind::kMove, name, nullptr, at(to, random.rotation())});
    if (!watched) continue;
    const auto after = store.find("room");
    const scene::SceneDifference change = scene::difference(*before, *after);
    const auto truth = from_scratch(*after, *watched, motion::Body(request.camera));
    EXPECT_EQ(watched->collisions(collision::Obstacles(*after), Deadline::never()), truth);
    if (!watched->may_meet(change)) {
      EXPECT_TRUE(truth.empty()) << "round " << round;
      ++unharmed;
    } else if (watched->stays_free(change, Deadline::never())) {
      EXPECT_TRUE(truth.empty()) << "round " << round;
      ++proved;
    } else {
      EXPECT_FALSE(truth.empty()) << "round " << round;
      ++broken;
    }
  }
  EXPECT_GT(broken, 20);
  EXPECT_GT(unharmed, 20);
  EXPECT_GT(proved, 20);
}

/// The box around a path that dismisses changes is large enough: it does not dismiss an object that
/// touches the body at its furthest point.
TEST(WatchedPath, DismissesNothingThatIsTooNear) {
  testing::Random random(7352);
  for (const double clearance_m : {0.0, 0.3}) {
    for (int round = 0; round < 100; ++round) {
      PlanRequest request = random_path_request(3 + random() % 4, random);
      request.options.clearance_m = clearance_m;
      const auto before = scene::assemble("room", 1, {}, {});
      const PlanResult planned = plan(*before, request);
      const std::optional<WatchedPath> watched = WatchedPath::of(request, planned);
      ASSERT_TRUE(watched) << planned.message;
      // A small box at a corner of the near quadrilateral, or just within the required clearance.
      const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
      const motion::Pose pose = planned.path.pose(
          planned.path.begin_s() + share * (planned.path.end_s() - planned.path.begin_s()));
      const Vec3 corner_C = motion::near_corners_C(request.camera)[random() % 4];
      const Vec3 outwards = (pose.orientation * corner_C).normalized();
      const Vec3 speck =
          pose.position + pose.orientation * corner_C + 0.99 * clearance_m * outwards;
      std::string fault;
      const auto placed =
          scene::place_object("speck", box_source(Vec3::Constant(1e-3)), at(speck), {});
      const auto after = scene::assemble("room", 2, {placed.object}, {});
      const scene::SceneDifference change = scene::difference(*before, *after);
      EXPECT_TRUE(watched->may_meet(change));
      EXPECT_FALSE(watched->stays_free(change, Deadline::never()));
      EXPECT_FALSE(watched->collisions(collision::Obstacles(*after), Deadline::never()).empty());
    }
  }
}

TEST(WatchedPath, TakingAwayNeverBreaks) {
  scene::SceneStore store;
  store.put(scene::assemble("room", 1, {}, {}));
  store.change("room", {SceneChange::Kind::kPut, "a", box_source(Vec3::Ones()), at({0, 2, 0})});
  const auto before = store.find("room");
  testing::Random random(7353);
  PlanRequest request = random_path_request(3 + random() % 4, random);
  const std::optional<WatchedPath> watched = WatchedPath::of(request, plan(*before, request));
  ASSERT_TRUE(watched);
  store.change("room", {SceneChange::Kind::kRemove, "a", nullptr, {}});
  EXPECT_TRUE(
      watched->stays_free(scene::difference(*before, *store.find("room")), Deadline::after_s(0.0)));
}

/// Far from all faces, but in the middle of the added solid.
TEST(WatchedPath, SeesThatItIsInsideASolid) {
  const auto empty = scene::assemble("room", 1, {}, {});
  testing::Random random(7356);
  const PlanRequest request = random_path_request(3 + random() % 4, random);
  const std::optional<WatchedPath> watched = WatchedPath::of(request, plan(*empty, request));
  ASSERT_TRUE(watched);
  scene::VoxelSet voxels;
  for (std::int32_t x = -30; x < 30; ++x) {
    for (std::int32_t y = -30; y < 30; ++y) {
      for (std::int32_t z = -30; z < 30; ++z) voxels.insert(scene::Voxel{x, y, z});
    }
  }
  const auto map =
      scene::VoxelMap::build(1.0, std::move(voxels), {}, scene::UnknownSpace::kFree).map;
  ASSERT_TRUE(map);
  const auto source = scene::make_map_source(map, scene::report_of(*map, "map"), {}, Vec3::Zero());
  const auto placed = scene::place_object("map", source, at({0, 0, 0}), {});
  ASSERT_TRUE(placed.object) << placed.error;
  const auto after = scene::assemble("room", 2, {placed.object}, {});
  const scene::SceneDifference change = scene::difference(*empty, *after);
  EXPECT_TRUE(watched->may_meet(change));
  EXPECT_FALSE(watched->stays_free(change, Deadline::never()));
  EXPECT_FALSE(watched->collisions(collision::Obstacles(*after), Deadline::never()).empty());
}

TEST(WatchedPath, KnowsNothingAfterTheDeadline) {
  const auto empty = scene::assemble("room", 1, {}, {});
  testing::Random random(7354);
  const PlanRequest request = random_path_request(3 + random() % 4, random);
  const std::optional<WatchedPath> watched = WatchedPath::of(request, plan(*empty, request));
  ASSERT_TRUE(watched);
  const auto placed = scene::place_object("a", box_source(Vec3::Ones()),
                                          at(watched->path().pose(0.1).position), {});
  const auto after = scene::assemble("room", 2, {placed.object}, {});
  EXPECT_FALSE(watched->stays_free(scene::difference(*empty, *after), Deadline::after_s(0.0)));
  EXPECT_EQ(watched->collisions(collision::Obstacles(*after), Deadline::after_s(0.0)),
            (std::vector{watched->everywhere()}));
}

TEST(WatchedPath, UsesTheSmallerCameraThatWasProved) {
  const auto empty = scene::assemble("room", 1, {}, {});
  testing::Random random(7355);
  PlanRequest request = random_path_request(3 + random() % 4, random);
  request.keyframes.resize(2);
  request.keyframes[0].pose = {Vec3(0, 0, 0), Quat::Identity()};
  request.keyframes[1].pose = {Vec3(4, 0, 0), Quat::Identity()};
  PlanResult planned = plan(*empty, request);
  planned.near_scale = 0.5;
  const std::optional<WatchedPath> watched = WatchedPath::of(request, planned);
  ASSERT_TRUE(watched);
  // A bar that the near quadrilateral cuts at its full near distance, and passes behind at half of
  // it.
  const auto placed =
      scene::place_object("bar", box_source({1.0, 0.1, 0.1}), at({2, 0, -0.12}), {});
  const auto after = scene::assemble("room", 2, {placed.object}, {});
  EXPECT_TRUE(watched->collisions(collision::Obstacles(*after), Deadline::never()).empty());
  PlanRequest as_body = request;
  as_body.body = std::exchange(as_body.camera, {});
  EXPECT_TRUE(WatchedPath::of(as_body, planned)
                  ->collisions(collision::Obstacles(*after), Deadline::never())
                  .empty());
  planned.near_scale = 1.0;
  EXPECT_FALSE(WatchedPath::of(request, planned)
                   ->collisions(collision::Obstacles(*after), Deadline::never())
                   .empty());
}

TEST(WatchedPath, KnowsThePathAsInterpolatedWhereItWasCorrected) {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  constexpr double kBegin_s = 1.76e9;  // seconds since 1970
  request.keyframes = {{kBegin_s, {Vec3(0, 0, 0), Quat::Identity()}},
                       {kBegin_s + 4.0, {Vec3(4, 0, 0), Quat::Identity()}}};
  const auto empty = scene::assemble("room", 1, {}, {});
  EXPECT_FALSE(WatchedPath::as_interpolated(request, plan(*empty, request))) << "it is free";
  const auto placed = scene::place_object("box", box_source({0.4, 0.4, 0.4}), at({2, 0, 0}), {});
  const auto after = scene::assemble("room", 2, {placed.object}, {});
  const PlanResult corrected = plan(*after, request);
  ASSERT_EQ(corrected.status, Status::kOk) << corrected.message;
  const auto watched = WatchedPath::as_interpolated(request, corrected);
  ASSERT_TRUE(watched);
  EXPECT_EQ(watched->path().begin_s(), kBegin_s);
  EXPECT_EQ(watched->path().end_s(), kBegin_s + 4.0);
  EXPECT_LT((watched->path().pose(kBegin_s + 2.0).position - Vec3(2, 0, 0)).norm(), 1e-9);
  const auto found = watched->collisions(collision::Obstacles(*after), Deadline::never());
  ASSERT_EQ(found.size(), corrected.collisions.size());
  EXPECT_NEAR(found[0].t_begin_s, corrected.collisions[0].t_begin_s, 0.01);
  EXPECT_TRUE(watched->collisions(collision::Obstacles(*empty), Deadline::never()).empty());
}

}  // namespace
}  // namespace camway::planning
