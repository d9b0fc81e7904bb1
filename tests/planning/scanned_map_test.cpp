// SPDX-License-Identifier: MIT
//
// Planning and watching while a map is scanned repeatedly.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "daemon/planning/plan.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/voxels/map_scan.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/watched_scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using geometry::Vec3;
using scene::VoxelMap;
using testing::random_path_request;

constexpr double kVoxelM = 0.25;

using Map = std::shared_ptr<const VoxelMap>;
using Scene = std::shared_ptr<const scene::Snapshot>;

Scene with(const Scene& before, const Map& map) {
  const auto source =
      scene::make_map_source(map, scene::report_of(*map, "map"), {}, geometry::Vec3::Zero());
  const scene::SnapshotResult result = scene::changed(
      *before, {scene::SceneChange::Kind::kPut, "map", source, {}}, before->revision + 1);
  EXPECT_TRUE(result.snapshot) << result.error;
  return result.snapshot;
}

Map anew(const VoxelMap& map) {
  scene::VoxelSet occupied;
  scene::VoxelSet free;
  map.occupied().for_each([&](const scene::Voxel& voxel) { occupied.insert(voxel); });
  map.free().for_each([&](const scene::Voxel& voxel) { free.insert(voxel); });
  return VoxelMap::build(kVoxelM, std::move(occupied), std::move(free), map.unknown()).map;
}

std::vector<Vec3> sight(int points, testing::Random& random) {
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::vector<Vec3> seen;
  for (int i = 0; i < points; ++i) seen.emplace_back(place(random), place(random), place(random));
  return seen;
}

void expect_equal(const PlanResult& a, const PlanResult& b) {
  ASSERT_EQ(a.status, b.status);
  ASSERT_EQ(a.message, b.message);
  ASSERT_EQ(a.certificate.certified, b.certificate.certified);
  ASSERT_EQ(a.certificate.clearance_lower_bound_m, b.certificate.clearance_lower_bound_m);
  ASSERT_EQ(a.collisions, b.collisions);
  ASSERT_EQ(a.remaining_collisions, b.remaining_collisions);
  ASSERT_EQ(a.path.segments().size(), b.path.segments().size());
  for (std::size_t i = 0; i < a.path.segments().size(); ++i) {
    const motion::Segment& one = a.path.segments()[i];
    const motion::Segment& other = b.path.segments()[i];
    ASSERT_EQ(one.t0_s, other.t0_s);
    ASSERT_EQ(one.t1_s, other.t1_s);
    ASSERT_EQ(one.position, other.position);
    ASSERT_EQ(one.orientation, other.orientation);
  }
}

TEST(ScannedMap, IsPlannedInLikeOneThatIsMadeAnew) {
  testing::Random random(7361);
  const Scene empty = scene::assemble("room", 1, {}, {});
  Map map = VoxelMap::build(kVoxelM, {}, {}, scene::UnknownSpace::kFree).map;
  Scene now = with(empty, map);
  int corrected = 0;
  for (int round = 0; round < 12; ++round) {
    map = scene::scanned(*map, {Vec3(0.1, 0.1, 0.1), sight(30, random)}).map;
    now = with(now, map);
    const Scene other = with(empty, anew(*map));
    for (int i = 0; i < 3; ++i) {
      const PlanRequest request = random_path_request(3, random);
      const PlanResult result = plan(*now, request, Deadline::never());
      ASSERT_NO_FATAL_FAILURE(expect_equal(result, plan(*other, request, Deadline::never())));
      corrected += result.corrections.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(corrected, 3);
}

/// The check of a watched path after a scan never says free if the whole scene does not.
TEST(ScannedMap, WatchedPathsSeeWhatAScanChanged) {
  testing::Random random(7362);
  const Scene empty = scene::assemble("room", 1, {}, {});
  int broken = 0;
  int unharmed = 0;
  for (const scene::UnknownSpace unknown :
       {scene::UnknownSpace::kFree, scene::UnknownSpace::kOccupied}) {
    for (int trial = 0; trial < 40; ++trial) {
      const Vec3 origin(0.1, 0.1, 0.1);
      Map map = VoxelMap::build(kVoxelM, {}, {}, unknown).map;
      // A change of a few voxels, far from most paths.
      map = scene::scanned(*map, {origin, std::vector<Vec3>{Vec3(0.2, 0.6, 0.2)}}).map;
      const Scene before = with(empty, map);
      const PlanRequest request = random_path_request(2, random);
      const PlanResult planned = plan(*before, request);
      const std::optional<WatchedPath> watched = WatchedPath::of(request, planned);
      if (!watched) continue;
      map = scene::scanned(*map, {origin, sight(trial % 20, random)}).map;
      const Scene now = with(before, map);
      const bool is_free =
          watched->collisions(collision::Obstacles(*now), Deadline::never()).empty();
      const scene::SceneDifference change = scene::difference(*before, *now);
      if (!is_free) {
        ASSERT_TRUE(watched->may_meet(change)) << "trial " << trial;
        ASSERT_FALSE(watched->stays_free(change, Deadline::never())) << "trial " << trial;
      }
      (is_free ? unharmed : broken) += 1;
    }
  }
  EXPECT_GT(broken, 10);
  EXPECT_GT(unharmed, 10);
}

}  // namespace
}  // namespace camway::planning
