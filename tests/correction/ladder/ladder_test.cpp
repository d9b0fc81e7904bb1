// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/collision/near_quad.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/gap_problems.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Keyframe;
using scene::Mesh;

// Returns a path past a column that stands a little in the way.
LadderCase column() {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.1, -3, -0.2}, {0.5, 3, 0.0});
  return case_with(mesh, {at(0, {-0.15, 0, 2}), at(3, {-0.15, 0, 0.9}), at(6, {-0.15, 0, -2})});
}

// Returns a wall that is endless in y, with a door at x in [2, 3.5].
LadderCase wall_with_door() {
  Mesh mesh;
  testing::add_cuboid(mesh, {-6, -8, -0.05}, {2, 8, 0.05});
  testing::add_cuboid(mesh, {3.5, -8, -0.05}, {9, 8, 0.05});
  return case_with(mesh, {at(0, {0, 0, 2}), at(5, {0, 0, -2})});
}

void expect_same_keyframes(const LadderCase& c, const CubicPath& path) {
  const motion::Path segments = path.path();
  for (const Keyframe& keyframe : c.keyframes) {
    const motion::Pose pose = segments.pose(keyframe.time_s);
    EXPECT_EQ(pose.position, keyframe.pose.position);
    EXPECT_LT(pose.orientation.angularDistance(keyframe.pose.orientation), 1e-12);
  }
}

void expect_corrected(const LadderCase& c, const std::vector<CorrectionKind>& kinds) {
  const LadderResult result = c.corrected();
  EXPECT_TRUE(c.collisions(result.path).empty());
  expect_same_keyframes(c, result.path);
  ASSERT_FALSE(result.corrections.empty());
  for (const Correction& correction : result.corrections) {
    EXPECT_TRUE(std::ranges::count(kinds, correction.kind) == 1)
        << static_cast<int>(correction.kind);
  }
}

TEST(Ladder, MovesPastAColumn) { expect_corrected(column(), {CorrectionKind::kMove}); }

// Within the wall the near quadrilateral touches nothing. No small move leads there.
TEST(Ladder, MovesPastAWallThatIsThickerThanTheCamera) {
  constexpr double kBesideTheWall_m = 0.3;  // three times half the width of the near quadrilateral
  testing::Random random(4713);
  for (int run = 0; run < 20; ++run) {
    Mesh mesh;
    const double overlap_m = random.uniform(0.02, 0.2);
    testing::add_cuboid(mesh, {-0.8, -3, -random.uniform(0.4, 1.0)}, {overlap_m, 3, 0});
    const LadderCase c = case_with(mesh, {at(0, {0, 0, 4}), at(8, {0, 0, -4})});
    const LadderResult result = c.corrected();
    EXPECT_TRUE(c.collisions(result.path).empty());
    for (const Correction& correction : result.corrections) {
      EXPECT_EQ(correction.kind, CorrectionKind::kMove) << "overlap " << overlap_m;
    }
    for (double time_s = 0.0; time_s <= 8.0; time_s += 0.05) {
      const double moved_m = result.path.pose(time_s).position.head<2>().norm();
      EXPECT_LT(moved_m, overlap_m + kBesideTheWall_m) << time_s;
    }
  }
}

TEST(Ladder, GoesThroughADoor) { expect_corrected(wall_with_door(), {CorrectionKind::kGoRound}); }

// The near quadrilateral is 0.4 wide and 0.3 high; the gap is 0.34 wide and endless in y.
TEST(Ladder, TurnsToPassAGapNarrowerThanTheCamera) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-40, -60, -0.05}, {-0.17, 60, 0.05});
  testing::add_cuboid(mesh, {0.17, -60, -0.05}, {40, 60, 0.05});
  LadderCase c = case_with(mesh, {at(0, {0, 0, 1.5}), at(4, {0, 0, -1.5})});
  c.body =
      motion::Body(motion::Camera{2.0 * std::atan(0.2 / 0.2), 2.0 * std::atan(0.15 / 0.2), 0.2});
  expect_corrected(c, {CorrectionKind::kTurn, CorrectionKind::kGoRound});
}

// Returns a closed room of 2.4 x 2.4 x 3.6 m.
Mesh closed_room() {
  Mesh mesh;
  testing::add_cuboid(mesh, {-1.3, -1.3, 1.8}, {1.3, 1.3, 1.9});
  testing::add_cuboid(mesh, {-1.3, -1.3, -1.9}, {1.3, 1.3, -1.8});
  for (const double wall_m : {-1.25, 1.25}) {
    testing::add_cuboid(mesh, {wall_m - 0.05, -1.3, -1.8}, {wall_m + 0.05, 1.3, 1.8});
    testing::add_cuboid(mesh, {-1.2, wall_m - 0.05, -1.8}, {1.2, wall_m + 0.05, 1.8});
  }
  return mesh;
}

/// Adds a wall across the room, 2 cm thick, with a hole between two corners.
void add_wall(Mesh& mesh, double z_m, const Vec3& low, const Vec3& high) {
  testing::add_cuboid(mesh, {-1.2, -1.2, z_m - 0.01}, {low[0], 1.2, z_m + 0.01});
  testing::add_cuboid(mesh, {high[0], -1.2, z_m - 0.01}, {1.2, 1.2, z_m + 0.01});
  testing::add_cuboid(mesh, {low[0], -1.2, z_m - 0.01}, {high[0], low[1], z_m + 0.01});
  testing::add_cuboid(mesh, {low[0], high[1], z_m - 0.01}, {high[0], 1.2, z_m + 0.01});
}

/// Returns a camera with a quadrilateral of 40 x 30 cm.
motion::Body square_camera() {
  return motion::Body(motion::Camera{2.0 * std::atan(0.2 / 0.2), 2.0 * std::atan(0.15 / 0.2), 0.2});
}

// The diagonal of the hole is 1.2 times the short side of the near quadrilateral, which has to pass
// with its long side first, rolled by 45 degrees.
TEST(Ladder, ThreadsAHoleLittleWiderThanTheShortSide) {
  Mesh mesh = closed_room();
  add_wall(mesh, 0.0, {-0.127, -0.127, 0}, {0.127, 0.127, 0});
  LadderCase c = case_with(mesh, {at(0, {-0.4, 0.2, 1.1}), at(4, {0.3, 0.1, -0.8})});
  c.body = square_camera();
  expect_corrected(c, {CorrectionKind::kGoRound});
}

// A slit, and behind it a hole that is displaced and needs another roll.
TEST(Ladder, ThreadsTwoHolesInARow) {
  Mesh mesh = closed_room();
  add_wall(mesh, 0.6, {-0.7, 0.1, 0}, {-0.3, 0.17, 0});
  add_wall(mesh, -0.6, {0.3, -0.6, 0}, {0.45, -0.2, 0});
  LadderCase c = case_with(mesh, {at(0, {-0.4, 0.2, 1.4}), at(4, {0.3, 0.1, -1.4})});
  c.body = square_camera();
  expect_corrected(c, {CorrectionKind::kGoRound});
}

// Less than a metre apart, and 28 m along the only way: around the end of a wall in a closed room.
TEST(Ladder, FindsWaysMuchLongerThanTheirEndsAreApart) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-8.2, -1.4, -2.2}, {8.2, -1.2, 2.2});
  testing::add_cuboid(mesh, {-8.2, 1.2, -2.2}, {8.2, 1.4, 2.2});
  testing::add_cuboid(mesh, {-8.2, -1.2, -2.2}, {8.2, 1.2, -2});
  testing::add_cuboid(mesh, {-8.2, -1.2, 2}, {8.2, 1.2, 2.2});
  testing::add_cuboid(mesh, {-8.2, -1.2, -2}, {-8, 1.2, 2});
  testing::add_cuboid(mesh, {8, -1.2, -2}, {8.2, 1.2, 2});
  testing::add_cuboid(mesh, {-8, -1.2, -0.1}, {7, 1.2, 0.1});
  expect_corrected(case_with(mesh, {at(0, {-7, 0, 0.4}), at(5, {-7, 0, -0.4})}),
                   {CorrectionKind::kGoRound});
}

// The coarse lattice, with steps of a metre, finds the end of the wall first.
TEST(Ladder, TakesAWindowNearbyRatherThanTheEndOfAWall) {
  Mesh mesh;
  testing::add_wall_with_window(mesh);
  const LadderCase c = case_with(mesh, {at(0, {0, 0, 4}), at(8, {0, 0, -4})});
  const LadderResult result = c.corrected();
  EXPECT_TRUE(c.collisions(result.path).empty());
  double farthest_m = 0.0;
  for (int i = 0; i <= 100; ++i) {
    farthest_m = std::max(farthest_m, result.path.pose(0.08 * i).position.head<2>().norm());
  }
  EXPECT_LT(farthest_m, 2.0);
}

TEST(Ladder, LeavesWhatItCannotCorrect) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const LadderCase c = case_with(mesh, {at(0, {0, 0, 3}), at(2, {0, 0, 0.2})});
  const LadderResult result = c.corrected();
  ASSERT_EQ(result.corrections.size(), 1U);
  EXPECT_EQ(result.corrections[0].kind, CorrectionKind::kNone);
  EXPECT_TRUE(result.inserted_s.empty());
  EXPECT_EQ(result.path.pieces.size(), c.path().pieces.size());
}

// There is no path then, but the given keyframe of the request was another one.
TEST(Ladder, ProvesNothingByKeyframesThatWereRepaired) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  LadderCase c = case_with(mesh, {at(0, {0, 0, 3}), at(2, {0, 0, 0.2}), at(4, {0, 0, 0.1})});
  ASSERT_TRUE(c.corrected().separation);
  EXPECT_EQ(c.corrected().separation->inside, 1U);
  c.keyframes[1].is_repaired = true;
  ASSERT_TRUE(c.corrected().separation);
  EXPECT_EQ(c.corrected().separation->inside, 2U);
  c.keyframes[2].is_repaired = true;
  EXPECT_FALSE(c.corrected().separation);
  EXPECT_FALSE(c.corrected().cage);
}

// Closed surfaces are tested before the large lattices are searched.
TEST(Ladder, ProvesBeforeItSearchesFar) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-20, -20, -20}, {20, 20, 20});
  const LadderCase c = case_with(mesh, {at(0, {0, 0, 19.4}), at(4, {0.3, 0.1, 20.6})});
  const LadderResult result = c.corrected();
  ASSERT_TRUE(result.separation);
  EXPECT_EQ(result.separation->triangles.size(), 12U);
  for (const Correction& correction : result.corrections)
    EXPECT_LT(correction.tried.lattice_points, 40'000);
}

// The parts of the path outside of the changed ranges keep their bits.
TEST(Ladder, IsLocal) {
  LadderCase c = column();
  for (int i = 1; i <= 4; ++i) c.keyframes.push_back(at(6 + 2 * i, {-0.15, 0, -2.0 - i}));
  const CubicPath before = c.path();
  const LadderResult result = c.corrected();
  EXPECT_LT(result.corrections.back().t_end_s, c.keyframes.back().time_s - 4.0);
  for (const motion::CubicPiece& piece : before.pieces) {
    if (piece.t0_s < result.corrections.back().t_end_s) continue;
    EXPECT_TRUE(std::ranges::any_of(result.path.pieces, [&](const motion::CubicPiece& other) {
      return other.t0_s == piece.t0_s && other.position == piece.position &&
             other.image == piece.image;
    }));
  }
}

// The path weaves between plates from either side. Where it collides without one knot, others may
// still be removed.
TEST(Ladder, InsertsFewKeyframesAlongASlalom) {
  testing::Random random(4711);
  std::size_t plates = 0;
  std::size_t inserted = 0;
  for (int run = 0; run < 12; ++run) {
    Mesh mesh;
    const int count = random.integer(5, 9);
    for (int i = 0; i < count; ++i) {
      const double z = -2.0 * i - random.uniform(0.7, 1.3);
      const double edge_m = random.uniform(-0.1, 0.3);
      const bool is_left = i % 2 == 0;
      testing::add_cuboid(mesh, {is_left ? -9 : -edge_m, -9, z},
                          {is_left ? edge_m : 9, 9, z + 0.05});
    }
    const LadderCase c = case_with(mesh, {at(0, {0, 0, 1}), at(count, {0, 0, -1.0 * count}),
                                          at(2 * count, {0, 0, -2.0 * count - 1})});
    const LadderResult result = c.corrected();
    EXPECT_TRUE(c.collisions(result.path).empty());
    plates += static_cast<std::size_t>(count);
    inserted += result.inserted_s.size();
  }
  // Without, there are 2.8 for each plate.
  EXPECT_LT(2 * inserted, 5 * plates);
}

TEST(Ladder, InsertsNoMoreKeyframesThanAllowed) {
  LadderCase c = wall_with_door();
  c.options.max_inserted_keyframes = 2;
  const LadderResult result = c.corrected();
  EXPECT_LE(result.inserted_s.size(), 2U);
  EXPECT_FALSE(c.collisions(result.path).empty());
}

TEST(Ladder, KeepsTheRequiredClearance) {
  LadderCase c = column();
  c.detect.clearance_m = 0.1;
  expect_corrected(c, {CorrectionKind::kMove, CorrectionKind::kTurn, CorrectionKind::kGoRound});
}

TEST(Ladder, CorrectsBodiesThatAreNoCameras) {
  LadderCase c = column();
  c.body = *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.3, 0.2, 0.1)});
  expect_corrected(c, {CorrectionKind::kMove, CorrectionKind::kTurn, CorrectionKind::kGoRound});
}

// Returns a tour through clutter, with several collisions in adjacent intervals between keyframes.
LadderCase cluttered_tour(testing::Random& random) {
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  for (;;) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 6; ++i) {
      const Vec3 eye(place(random), place(random), place(random));
      keyframes.push_back({1.5 * i, {eye, random.rotation()}});
    }
    LadderCase c = case_with(testing::scattered_triangles(random, 25, 0.3), std::move(keyframes));
    const motion::Corners corners_C = motion::near_corners_C(testing::small_camera());
    const bool all_free = std::ranges::none_of(c.keyframes, [&](const Keyframe& keyframe) {
      return collision::collides(c.index, corners_C, keyframe.pose);
    });
    if (all_free && c.collisions(c.path()).size() >= 2) return c;
  }
}

bool covers(const Correction& correction, double time_s) {
  return correction.kind != CorrectionKind::kNone && correction.t_begin_s <= time_s &&
         time_s <= correction.t_end_s;
}

// The fields of each correction, compared with the returned path at many times.
TEST(Ladder, TellsWhatBecameOfThePath) {
  testing::Random random(4501);
  int corrected = 0;
  constexpr std::array kObjectives = {Objective::kClosest, Objective::kShortest,
                                      Objective::kSmoothest, Objective::kSafest};
  for (int run = 0; run < 12; ++run) {
    LadderCase c = cluttered_tour(random);
    c.options.objective = kObjectives[static_cast<std::size_t>(run) % kObjectives.size()];
    const CubicPath before = c.path();
    const LadderResult result = c.corrected();
    expect_same_keyframes(c, result.path);
    constexpr int kTimes = 20000;
    std::vector<double> moved_m(result.corrections.size());
    std::vector<double> turned_rad(result.corrections.size());
    for (int i = 0; i <= kTimes; ++i) {
      const double time_s = std::lerp(before.begin_s(), before.end_s(), i / double{kTimes});
      const motion::Pose was = before.pose(time_s);
      const motion::Pose is = result.path.pose(time_s);
      bool is_covered = false;
      for (std::size_t k = 0; k < result.corrections.size(); ++k) {
        if (!covers(result.corrections[k], time_s)) continue;
        is_covered = true;
        moved_m[k] = std::max(moved_m[k], (is.position - was.position).norm());
        turned_rad[k] = std::max(turned_rad[k], is.orientation.angularDistance(was.orientation));
      }
      if (is_covered) continue;
      // A remaining part of a piece that was cut differs by rounding.
      constexpr double kPoseRounding = 1e-14;
      ASSERT_LT((is.position - was.position).norm(), kPoseRounding) << run << " at " << time_s;
      ASSERT_LT((is.orientation.coeffs() - was.orientation.coeffs()).norm(), kPoseRounding) << run;
    }
    for (std::size_t k = 0; k < result.corrections.size(); ++k) {
      const Correction& correction = result.corrections[k];
      if (correction.kind == CorrectionKind::kNone) continue;
      ++corrected;
      EXPECT_LE(before.begin_s(), correction.t_begin_s);
      EXPECT_LT(correction.t_begin_s, correction.t_end_s);
      EXPECT_LE(correction.t_end_s, before.end_s());
      // The test takes samples.
      EXPECT_NEAR(correction.moved_m, moved_m[k], 1e-4 * moved_m[k]) << run;
      EXPECT_NEAR(correction.turned_rad, turned_rad[k], 1e-4 * turned_rad[k] + 1e-7) << run;
      EXPECT_GT(moved_m[k] + turned_rad[k], 0.0);
      // The changed range contains the collision.
      EXPECT_LT(correction.t_begin_s, correction.interval.t_end_s);
      EXPECT_GT(correction.t_end_s, correction.interval.t_begin_s);
    }
  }
  EXPECT_GT(corrected, 12);
}

bool is_same(const CubicPath& a, const CubicPath& b) {
  return std::ranges::equal(a.pieces, b.pieces,
                            [](const motion::CubicPiece& x, const motion::CubicPiece& y) {
                              return x.t0_s == y.t0_s && x.position == y.position;
                            });
}

// Each objective is at least as good by its own measure as the closest path, and in most corrected
// tours it is better.
TEST(Ladder, ObjectivesAreBestByTheirOwnMeasure) {
  testing::Random random(4503);
  std::map<Objective, int> better;
  int corrected = 0;
  constexpr int kRuns = 24;
  for (int run = 0; run < kRuns; ++run) {
    LadderCase c = cluttered_tour(random);
    const CubicPath original = c.path();
    const LadderResult result = c.corrected();
    const CubicPath& closest = result.path;
    corrected += result.inserted_s.empty() ? 0 : 1;
    FreeSpace space(c.query(), c.options.orientation);
    for (const Objective objective :
         {Objective::kShortest, Objective::kSmoothest, Objective::kSafest}) {
      c.options.objective = objective;
      const LadderResult polished = c.corrected();
      const CubicPath& path = polished.path;
      EXPECT_EQ(polished.is_polished, !is_same(path, closest)) << run;
      const ObjectiveCost now = objective_cost(objective, path, original, space, Deadline::never());
      const ObjectiveCost before =
          objective_cost(objective, closest, original, space, Deadline::never());
      // The measure sums over intervals at other samples than those that were compared.
      EXPECT_LE(now.value, 1.001 * before.value) << run << ": " << static_cast<int>(objective);
      const auto clearance =
          collision::path_clearance(c.query().obstacles, path.path(), c.body, Deadline::never());
      EXPECT_GT(clearance->lower_bound_m, 0.0) << run;
      // The least gap of the others is sampled, and capped below the distance of two samples.
      if (objective == Objective::kSafest) {
        EXPECT_GE(now.least_gap_m, (1.0 - collision::kClearanceTolerance) * before.least_gap_m)
            << run;
      }
      better[objective] += now.value < 0.99 * before.value ? 1 : 0;
      // The path keeps its orientation where no rotation was necessary.
      for (int i = 0; i <= 200; ++i) {
        const double time_s = std::lerp(path.begin_s(), path.end_s(), i / 200.0);
        EXPECT_LT(path.pose(time_s).orientation.angularDistance(closest.pose(time_s).orientation),
                  1e-6);
      }
    }
  }
  EXPECT_GT(corrected, kRuns / 2);
  for (const auto& [objective, count] : better)
    EXPECT_GT(2 * count, corrected) << static_cast<int>(objective);
}

// Returns two walls with doors beside the interpolated path.
LadderCase two_walls(testing::Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Mesh mesh;
  for (const double z : {0.8, -0.8}) {
    const double door = 1.2 * unit(random);
    testing::add_cuboid(mesh, {-6, -8, z - 0.05}, {door - 0.4, 8, z + 0.05});
    testing::add_cuboid(mesh, {door + 0.4, -8, z - 0.05}, {6, 8, z + 0.05});
  }
  return case_with(mesh, {at(0, {unit(random), 0, 2.5}), at(3, {unit(random), 0, 0}),
                          at(6, {unit(random), 0, -2.5})});
}

// Relaxation minimises a sum of squares in place of the cost, so other objectives may cost less now
// and then, but more on the whole.
TEST(Ladder, ClosestCostsLeast) {
  testing::Random random(4504);
  int compared = 0;
  int beaten = 0;
  double sum_of_closest = 0.0;
  double sum_of_others = 0.0;
  for (int run = 0; run < 24; ++run) {
    LadderCase c = two_walls(random);
    const CubicPath original = c.path();
    FreeSpace space(c.query(), c.options.orientation);
    const auto cost = [&](Objective objective) {
      c.options.objective = objective;
      return objective_cost(Objective::kClosest, c.corrected().path, original, space,
                            Deadline::never())
          .value;
    };
    const double closest = cost(Objective::kClosest);
    for (const Objective objective : {Objective::kShortest, Objective::kSmoothest}) {
      const double other = cost(objective);
      ++compared;
      // Corrections are drawn on fewer keyframes for up to 1.25 times the cost.
      beaten += 1.25 * other < closest ? 1 : 0;
      sum_of_closest += closest;
      sum_of_others += other;
    }
  }
  EXPECT_LE(beaten, compared / 8);
  EXPECT_LT(sum_of_closest, sum_of_others);
}

TEST(Ladder, InsertsKeyframesWithinThePathAndBesideThoseGiven) {
  testing::Random random(4502);
  int inserted = 0;
  for (int run = 0; run < 8; ++run) {
    const LadderCase c = cluttered_tour(random);
    const LadderResult result = c.corrected();
    EXPECT_LE(result.inserted_s.size(), static_cast<std::size_t>(c.options.max_inserted_keyframes));
    double last_s = result.path.begin_s();
    for (const double time_s : result.inserted_s) {
      EXPECT_LT(last_s, time_s) << "in order, each once, and after the begin";
      last_s = time_s;
      EXPECT_LT(time_s, result.path.end_s());
      EXPECT_TRUE(std::ranges::any_of(result.corrections, [&](const Correction& correction) {
        return covers(correction, time_s);
      }));
      for (const Keyframe& keyframe : c.keyframes) EXPECT_NE(time_s, keyframe.time_s);
      ++inserted;
    }
  }
  EXPECT_GT(inserted, 20);
}

}  // namespace
}  // namespace camway::correction
