// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/best_by_objective.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "daemon/motion/spline/bump.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/objective_value.h"
#include "tests/bench/fidelity/test_shots.h"

namespace camway::bench {
namespace {

using correction::Objective;
using geometry::Vec3;
using motion::CubicPath;
using testing::Random;

constexpr std::array<Objective, 3> kObjectives{Objective::kShortest, Objective::kSmoothest,
                                               Objective::kSafest};
constexpr TimeRange kAll{0.0, 10.0};  // of all flights here

/// A straight flight along X, from -5 to 5 m.
std::vector<motion::Keyframe> straight_flight() {
  return {{0.0, {{-5.0, 0.0, 0.0}, geometry::Quat::Identity()}},
          {10.0, {{5.0, 0.0, 0.0}, geometry::Quat::Identity()}}};
}

/// A wall of 0.2 m at x = 0, with a door about the X axis in which the camera has 0.18 m to each
/// side.
std::shared_ptr<const scene::Snapshot> room_with_a_door() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.1, -8.0, -8.0}, {0.1, 8.0, -0.25});
  testing::add_cuboid(mesh, {-0.1, -8.0, 0.25}, {0.1, 8.0, 8.0});
  testing::add_cuboid(mesh, {-0.1, -8.0, -0.25}, {0.1, -0.25, 0.25});
  testing::add_cuboid(mesh, {-0.1, 0.25, -0.25}, {0.1, 8.0, 0.25});
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

/// The path with a bump of this size about the middle of the flight.
CubicPath bent(const CubicPath& path, const Vec3& size) {
  const motion::CubicPoint bump{size, geometry::Vec4::Zero()};
  const motion::BumpRow row{motion::KnotRow(1.0, 9.0, 8), 3, {bump, bump, bump}};
  return motion::with_bumps(path, std::span(&row, 1));
}

CubicPath best_from(Objective objective, const Shot& shot, const CubicPath& start, double seconds) {
  return best_by_objective(objective, shot, std::span(&start, 1), {{kAll}, {kAll}},
                           {.seconds = seconds});
}

TEST(BestByObjective, PassesTheMiddleOfADoor) {
  const std::shared_ptr<const scene::Snapshot> scene = room_with_a_door();
  const BenchRequest request = request_of(straight_flight());
  const Shot shot(*scene, request, 5.0);
  const CubicPath start = bent(shot.interpolated(), {0.0, 0.15, 0.12});
  ASSERT_TRUE(shot.certified_clearance_m(start.path()));
  const CubicPath best = best_from(Objective::kSafest, shot, start, 0.7);
  ASSERT_TRUE(shot.certified_clearance_m(best.path()));
  const double middle_m = proved_clearance_m(shot, shot.interpolated(), std::span(&kAll, 1));
  ASSERT_LT(proved_clearance_m(shot, start, std::span(&kAll, 1)), 0.7 * middle_m);
  ASSERT_LT(middle_m, sufficient_gap_m(shot));
  EXPECT_GE(proved_clearance_m(shot, best, std::span(&kAll, 1)), 0.95 * middle_m);
}

TEST(BestByObjective, IsAStraightLineWhereThatIsPossible) {
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(straight_flight());
  const Shot shot(*scene, request, 5.0);
  const CubicPath start = bent(shot.interpolated(), {0.0, 0.8, -0.5});
  const double longer = curve_cost(Objective::kShortest, start) / 10.0 - 1.0;
  ASSERT_GT(longer, 0.02);
  const CubicPath best = best_from(Objective::kShortest, shot, start, 0.7);
  EXPECT_GE(curve_cost(Objective::kShortest, best), 10.0 - kSame);
  EXPECT_LE(curve_cost(Objective::kShortest, best), 10.0 * (1.0 + 0.02 * longer));
}

TEST(BestByObjective, IsTheNaturalSplineWhereThatIsFree) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  for (int i = 0; i < 3; ++i) {
    const BenchRequest request = request_of(curved_flight(random));
    const Shot shot(*scene, request, 1.0);
    // No curve through the keyframes at their times bends less than the natural spline.
    const double least = curve_cost(Objective::kSmoothest, shot.interpolated());
    motion::BumpRow row{
        motion::KnotRow(4.0, 6.0, 4), 2, {{{0.1, 0.2, 0.3}, geometry::Vec4::Zero()}}};
    const CubicPath start = motion::with_bumps(shot.interpolated(), std::span(&row, 1));
    ASSERT_GT(curve_cost(Objective::kSmoothest, start), 1.5 * least);
    const CubicPath best = best_from(Objective::kSmoothest, shot, start, 0.4);
    EXPECT_GE(curve_cost(Objective::kSmoothest, best), (1.0 - kSame) * least);
    EXPECT_LE(curve_cost(Objective::kSmoothest, best), 1.05 * least);
  }
}

TEST(BestByObjective, ChangesItsRangesAlone) {
  Random random(5);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  const std::vector<TimeRange> ranges{{2.0, 4.0}, {6.0, 8.0}};
  const CubicPath best =
      best_by_objective(Objective::kShortest, shot, std::span(&shot.interpolated(), 1),
                        {ranges, ranges}, {.seconds = 0.4});
  for (const TimeRange& range : ranges) {
    const std::span one(&range, 1);
    EXPECT_LT(value_of(Objective::kShortest, shot, best, one),
              value_of(Objective::kShortest, shot, shot.interpolated(), one));
  }
  for (int i = 0; i <= 100; ++i) {
    const double time_s = 0.1 * i;
    if (std::ranges::any_of(ranges, [&](const TimeRange& range) {
          return range.begin_s < time_s && time_s < range.end_s;
        })) {
      continue;
    }
    EXPECT_LE((best.at(time_s).position - shot.interpolated().at(time_s).position).norm(), kSame);
  }
}

TEST(BestByObjective, KeepsWhatItMayNotChangeAndIsNoWorseThanAnyStart) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  for (const Objective objective : kObjectives) {
    const BenchRequest request = request_of(curved_flight(random));
    const Shot shot(*scene, request, 5.0);
    const Answer closest = planned(shot, shot.plan().options);
    planning::PlanOptions options = shot.plan().options;
    options.objective = objective;
    const Answer answer = planned(shot, options);
    ASSERT_TRUE(closest.is_proved() && answer.is_proved());
    const Extent extent = extent_of(objective, shot, closest.cubic, answer.cubic);
    const std::vector<TimeRange>& ranges = extent.compared;
    ASSERT_FALSE(ranges.empty());
    const std::vector<CubicPath> starts =
        starts_of(objective, shot, closest.cubic, answer.cubic, extent);
    const CubicPath best = best_by_objective(objective, shot, starts, extent, {.seconds = 0.3});
    EXPECT_TRUE(shot.certified_clearance_m(best.path()));
    const double value = value_of(objective, shot, best, ranges);
    EXPECT_TRUE(is_worse(objective, value_of(objective, shot, closest.cubic, ranges), value));
    for (const CubicPath& start : starts) {
      EXPECT_TRUE(shot.certified_clearance_m(start.path()));
      EXPECT_FALSE(is_worse(objective, value, value_of(objective, shot, start, ranges), 1e-9));
    }
    for (const motion::Keyframe& keyframe : shot.plan().keyframes) {
      const motion::Pose pose = best.pose(keyframe.time_s);
      EXPECT_LE((pose.position - keyframe.pose.position).norm(), kSame);
      EXPECT_LE(pose.orientation.angularDistance(keyframe.pose.orientation), 4.0 * kSame);
    }
    for (const TimeRange& changed : changed_ranges(best, shot.interpolated())) {
      EXPECT_TRUE(std::ranges::any_of(extent.searched, [&](const TimeRange& range) {
        return range.begin_s <= changed.begin_s && changed.end_s <= range.end_s;
      }));
    }
  }
}

TEST(BestByObjective, KeepsTheClearanceOfTheClosestPathWhereThatIsTight) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  const Answer closest = planned(shot, shot.plan().options);
  ASSERT_TRUE(closest.is_proved());
  const auto kept_m = [&](Objective objective) {
    return kept_clearance_m(objective, shot, closest.cubic, std::span(&kAll, 1));
  };
  EXPECT_EQ(kept_m(Objective::kSafest), shot.plan().options.clearance_m);
  EXPECT_EQ(kept_m(Objective::kShortest), kept_m(Objective::kSmoothest));
  EXPECT_LE(kept_m(Objective::kShortest), kTightGap * shot.space().ball_radius_m());
  EXPECT_LE(kept_m(Objective::kShortest), *closest.clearance_m);
  for (const double clearance_m : {kept_m(Objective::kShortest), 0.9 * *closest.clearance_m}) {
    const CubicPath best =
        best_by_objective(Objective::kShortest, shot, std::span(&closest.cubic, 1),
                          {{kAll}, {kAll}}, {.seconds = 0.3, .clearance_m = clearance_m});
    EXPECT_GE(proved_clearance_m(shot, best, std::span(&kAll, 1)),
              (1.0 - 2.0 * kClearanceError) * clearance_m);
    EXPECT_LT(curve_cost(Objective::kShortest, best),
              curve_cost(Objective::kShortest, closest.cubic));
  }
}

TEST(BestByObjective, DoesNotTurnTheCamera) {
  Random random(3);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  const Answer closest = planned(shot, shot.plan().options);
  ASSERT_TRUE(closest.is_proved());
  for (const Objective objective : kObjectives) {
    const CubicPath best = best_from(objective, shot, closest.cubic, 0.3);
    for (int i = 0; i <= 100; ++i) {
      const double time_s = 0.1 * i;
      const geometry::Quat turned = best.pose(time_s).orientation;
      EXPECT_LE(turned.angularDistance(closest.cubic.pose(time_s).orientation), 1e-7);
    }
  }
}

/// The path as interpolated, with a bump between two times.
CubicPath bumped_at(const Shot& shot, double begin_s, double end_s) {
  const motion::CubicPoint bump{{0.1, 0.2, 0.3}, geometry::Vec4::Zero()};
  const motion::BumpRow row{motion::KnotRow(begin_s, end_s, 4), 2, {bump}};
  return motion::with_bumps(shot.interpolated(), std::span(&row, 1));
}

TEST(ComparedRanges, AreIntervalsBetweenKeyframes) {
  Random random(4);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  // Keyframes are two seconds apart.
  const std::array paths{bumped_at(shot, 2.2, 3.1), bumped_at(shot, 2.5, 4.5),
                         bumped_at(shot, 8.5, 9.0)};
  const std::vector<TimeRange> ranges = compared_ranges(shot, paths);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].begin_s, 2.0);
  EXPECT_EQ(ranges[0].end_s, 6.0);
  EXPECT_EQ(ranges[1].begin_s, 8.0);
  EXPECT_EQ(ranges[1].end_s, 10.0);
}

TEST(Extent, ComparesTheLeastGapWhereTheClosestPathIsChanged) {
  Random random(4);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  const CubicPath closest = bumped_at(shot, 2.2, 3.1);
  const CubicPath answer = bumped_at(shot, 1.5, 3.1);
  for (const Objective objective : kObjectives) {
    const Extent extent = extent_of(objective, shot, closest, answer);
    ASSERT_EQ(extent.searched.size(), 1U);
    ASSERT_EQ(extent.compared.size(), 1U);
    EXPECT_EQ(extent.searched[0].begin_s, 0.0);
    EXPECT_EQ(extent.searched[0].end_s, 4.0);
    EXPECT_EQ(extent.compared[0].begin_s, objective == Objective::kSafest ? 2.0 : 0.0);
    EXPECT_EQ(extent.compared[0].end_s, 4.0);
  }
}

}  // namespace
}  // namespace camway::bench
