// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <optional>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "tests/correction/relaxation_case.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using base::Deadline;

/// A path along z over a cuboid, and a correction that lifts it over it.
struct Hurdle {
  RelaxationCase c;
  std::optional<Relaxed> free;
};

/// `height_m`: how far the cuboid reaches into the way. `z_m`: its place on the way.
Hurdle hurdle(double height_m, double thickness_m = 0.6, double z_m = 0.0) {
  Hurdle hurdle;
  RelaxationCase& c = hurdle.c;
  c.policy.rule = OrientationRule::kKeep;
  testing::add_plate_across(c.mesh, height_m, thickness_m);
  for (geometry::Vec3& vertex : c.mesh.vertices) vertex.z() += z_m;
  c.build();
  c.problem = testing::problem_along_z();
  hurdle.free = correction_with(c, lifted(c.problem, 8, {0, 1.5 * height_m, 0}), Ends::kFixed);
  return hurdle;
}

double cost(const RelaxationCase& c, const Relaxed& of) {
  return closeness_cost(of.candidate.path, c.problem.original, c.space().closeness());
}

double least_gap_m(const RelaxationCase& c, const Relaxed& of) {
  return least_gap_m(c, of.candidate.path, 0.0, 8.0, 4000);
}

Relaxed with_room(const RelaxationCase& c, const Relaxed& tight) {
  FreeSpace space = c.space();
  base::Budget budget(kEnoughSteps);
  return relaxed(c.problem, tight, Ends::kFixed, {.makes_room = true}, budget, space,
                 Deadline::never());
}

/// Relaxes until the path all but touches what it passes.
Relaxed tightened(const Hurdle& hurdle) {
  Relaxed tight = *hurdle.free;
  for (int i = 0; i < 4; ++i) {
    tight = relaxed_fully(hurdle.c, tight, Ends::kFixed, Objective::kClosest);
  }
  return tight;
}

double wanted_m(const RelaxationCase& c) {
  return ContactBounds(Objective::kClosest, c.space().ball_radius_m(),
                       c.space().closeness().viewing_distance_m)
      .wanted_m();
}

TEST(RelaxationRoom, LowersTheCostAndMakesNoRoomUnlessAsked) {
  const Hurdle low = hurdle(0.01);
  ASSERT_TRUE(low.free);
  const Relaxed tight = relaxed_fully(low.c, *low.free, Ends::kFixed, Objective::kClosest);
  EXPECT_LT(cost(low.c, tight), 0.9 * cost(low.c, *low.free));
  EXPECT_GT(least_gap_m(low.c, tight), 0.0);
  EXPECT_LT(least_gap_m(low.c, tight), 0.2 * wanted_m(low.c));
}

// Over what is high, room is cheap.
TEST(RelaxationRoom, MakesMostOfTheRoomThatIsAimedAtWhereItIsCheap) {
  for (const double height_m : {0.2, 0.5}) {
    const Hurdle high = hurdle(height_m);
    ASSERT_TRUE(high.free);
    const Relaxed tight = tightened(high);
    const Relaxed roomy = with_room(high.c, tight);
    EXPECT_LT(least_gap_m(high.c, tight), 0.35 * wanted_m(high.c)) << height_m;
    EXPECT_GT(least_gap_m(high.c, roomy), 0.6 * wanted_m(high.c)) << height_m;
    EXPECT_LE(cost(high.c, roomy), 1.2 * cost(high.c, tight)) << height_m;
  }
}

// Over a plate that is just touched, all of the room that is aimed at would cost a multiple.
TEST(RelaxationRoom, LeavesRoomThatIsTooDear) {
  const Hurdle low = hurdle(0.01);
  ASSERT_TRUE(low.free);
  const Relaxed tight = tightened(low);
  const Relaxed roomy = with_room(low.c, tight);
  EXPECT_LE(cost(low.c, roomy), 1.05 * cost(low.c, tight));
  EXPECT_GT(least_gap_m(low.c, roomy), 0.8 * least_gap_m(low.c, tight));
  EXPECT_LT(least_gap_m(low.c, roomy), 0.1 * wanted_m(low.c));
}

TEST(RelaxationRoom, MakesMoreRoomOverWhatIsHigher) {
  double before_m = 0.0;
  for (const double height_m : {0.01, 0.03, 0.06, 0.1, 0.2}) {
    const Hurdle next = hurdle(height_m);
    ASSERT_TRUE(next.free);
    const Relaxed roomy = with_room(next.c, tightened(next));
    EXPECT_GT(least_gap_m(next.c, roomy), before_m) << height_m;
    before_m = least_gap_m(next.c, roomy);
  }
}

// The least gap lies between two samples. Where next to nothing is left, the relaxation looks there.
TEST(RelaxationRoom, LooksCloserWhereNextToNoGapIsLeft) {
  testing::Draw draw(4541);
  constexpr int kRuns = 100;
  int tight_places = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Hurdle low = hurdle(draw.uniform(0.045, 0.07), 0.6, draw.uniform(-1.0, 1.0));
    ASSERT_TRUE(low.free);
    const Relaxed tight = tightened(low);
    const Relaxed roomy = with_room(low.c, tight);
    const FreeSpace space = low.c.space();
    const ContactBounds bounds(Objective::kClosest, space.ball_radius_m(),
                               space.closeness().viewing_distance_m);
    tight_places += least_gap_m(low.c, roomy) < bounds.little_m() ? 1 : 0;
    EXPECT_LE(cost(low.c, roomy), 1.25 * cost(low.c, tight)) << run;
  }
  EXPECT_LT(tight_places, kRuns / 10);
}

}  // namespace
}  // namespace camway::correction
