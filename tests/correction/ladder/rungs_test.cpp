// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/rungs.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/viewing_distance.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;

constexpr int kManySteps = 1000;  // of relaxation: more than any correction takes

/// The rungs for one interval between keyframes.
struct RungsCase {
  explicit RungsCase(const LadderCase& ladder)
      : interpolated(ladder.path()),
        space(ladder.query(), {},
              closeness_of(interpolated, FreeSpace(ladder.query()), /*viewing_distance_m=*/3.0)),
        corrected(interpolated, ladder.keyframes, {ladder.options.max_inserted_keyframes, 0.0},
                  never),
        collisions(ladder.collisions(interpolated), corrected.keyframes_s()),
        rungs(space, corrected, collisions, origin, /*seed=*/1) {}

  [[nodiscard]] double cost() const {
    return closeness_cost(corrected.path(), interpolated, space.closeness());
  }
  [[nodiscard]] CorrectionKind kind() const { return collisions[0].correction.kind; }

  const Deadline never = Deadline::never();
  const motion::TimeOrigin origin;
  const motion::CubicPath interpolated;
  FreeSpace space;
  CorrectedPath corrected;
  CollisionList collisions;
  Rungs rungs;
};

/// A path that meets a plate in one place, at a random depth below the plate's rim.
LadderCase plate_in_the_way(testing::Random& random) {
  scene::Mesh mesh;
  const double z_m = random.uniform(-2.0, 2.0);
  const auto rim_m = [&] { return random.uniform(0.1, 1.0); };
  testing::add_cuboid(mesh, {-rim_m(), -rim_m(), z_m - 0.02}, {rim_m(), rim_m(), z_m + 0.02});
  return case_with(mesh, {at(0, {0, 0, 3}), at(random.uniform(1.0, 8.0), {0, 0, -3})});
}

// The move alone is what `nudge` finds.
TEST(Rungs, TakeAWayRoundInsteadOfADearMoveIfItCostsLess) {
  testing::Random random(4551);
  int ways_round = 0;
  int moves = 0;
  for (int run = 0; run < 120; ++run) {
    const LadderCase ladder = plate_in_the_way(random);
    RungsCase c(ladder);
    Problem problem = c.corrected.part_about(0, c.origin, c.space.ball_radius_m());
    std::vector<collision::CollisionInterval> intervals = ladder.collisions(c.interpolated);
    ASSERT_EQ(c.collisions.open_near(0, 1.0).size(), intervals.size());
    problem.interval = {intervals.front().t_begin_s, intervals.back().t_end_s};
    base::Budget budget(kManySteps);
    const NudgeResult move = nudge(problem, intervals, NudgeKind::kMove, budget, c.space, c.never);
    ASSERT_EQ(c.rungs.move_away(0), move.candidate.has_value()) << run;
    if (!move.candidate) continue;
    const double move_cost =
        closeness_cost(move.candidate->path, c.interpolated, c.space.closeness());
    if (c.kind() == CorrectionKind::kGoRound) {
      EXPECT_LT(c.cost(), move_cost) << run;
      ++ways_round;
    } else {
      EXPECT_EQ(c.kind(), CorrectionKind::kMove);
      ++moves;
    }
    EXPECT_TRUE(ladder.collisions(c.corrected.path()).empty()) << run;
  }
  EXPECT_GT(ways_round, 3);
  EXPECT_GT(moves, 3);
}

}  // namespace
}  // namespace camway::correction
