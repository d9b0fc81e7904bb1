// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "daemon/collision/detect.h"
#include "daemon/collision/near_quad.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/smoothing_form.h"
#include "daemon/motion/path/measures.h"
#include "tests/correction/relaxation_case.h"
#include "tests/support/gap_problems.h"
#include "tests/support/sanitizer.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Keyframe;
using testing::Draw;

constexpr int kKnots = 12;
constexpr std::array kRelaxedObjectives = {Objective::kClosest, Objective::kShortest,
                                           Objective::kSmoothest, Objective::kSafest};

double length_m(const CubicPath& path) {
  const motion::Path segments = path.path();
  return motion::measure(segments, segments).length_m;
}

void expect_keyframes_kept(const RelaxationCase& c, const CubicPath& path) {
  for (const double time_s : c.problem.keyframes_s) {
    EXPECT_EQ(path.at(time_s).position, c.problem.path.at(time_s).position);
    EXPECT_EQ(path.at(time_s).image, c.problem.path.at(time_s).image);
  }
}

void expect_same(const CubicPath& a, const CubicPath& b) {
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    EXPECT_EQ(a.pieces[i].t0_s, b.pieces[i].t0_s);
    EXPECT_EQ(a.pieces[i].position, b.pieces[i].position);
    EXPECT_EQ(a.pieces[i].image, b.pieces[i].image);
  }
}

/// A tour through clutter in which one interval is crossed by a large swing that happens to be
/// free.
struct Swing {
  RelaxationCase c;
  Ends ends = Ends::kFree;
  std::optional<Relaxed> free;
};

Swing random_swing(Draw& draw, double max_turn_rad = std::numbers::pi) {
  Swing swing;
  swing.c.policy.max_turn_rad = max_turn_rad;
  while (!swing.free) {
    RelaxationCase& c = swing.c;
    c.mesh = testing::scattered_triangles(draw, 25, 0.4);
    c.build();
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 4; ++i) keyframes.push_back(at(1.5 * i, draw.in_cube(1.3), draw.turn(1.0)));
    c.problem = testing::problem_of_leg(keyframes, static_cast<std::size_t>(draw.integer(0, 2)));
    c.detect.clearance_m = draw.integer(0, 1) * 0.01;
    swing.ends = draw.integer(0, 2) == 0 ? Ends::kFixed : Ends::kFree;
    // The parts that the swing left unchanged may collide and are not corrected.
    c.problem.foreign_collisions =
        collision::detect_collisions({collision::Obstacles(c.index), c.body, c.detect},
                                     c.problem.path.path(), c.problem.path.begin_s(),
                                     c.problem.path.end_s(), Deadline::never())
            .value();
    std::erase_if(c.problem.foreign_collisions, [&](const collision::CollisionInterval& other) {
      return other.t_end_s > c.problem.leg_begin_s() && other.t_begin_s < c.problem.leg_end_s();
    });
    const int count = 8 << draw.integer(0, 2);
    Offsets offsets = lifted(c.problem, count, draw.in_cube(1.5));
    for (motion::CubicPoint& point : offsets.at)
      point.image = draw.image(0.1 * std::min(1.0, max_turn_rad));
    swing.free = correction_with(c, offsets, swing.ends);
  }
  return swing;
}

/// Expects the required distance at many times, except where other corrections are responsible.
void expect_free(const RelaxationCase& c, const CubicPath& path) {
  const motion::Corners corners_C = motion::near_corners_C(testing::small_camera());
  constexpr int kTimes = 3000;
  for (int i = 0; i <= kTimes; ++i) {
    const double time_s = std::lerp(path.begin_s(), path.end_s(), static_cast<double>(i) / kTimes);
    const bool in_foreign_collision = std::ranges::any_of(
        c.problem.foreign_collisions, [&](const collision::CollisionInterval& other) {
          return other.t_begin_s <= time_s && time_s <= other.t_end_s;
        });
    if (in_foreign_collision) continue;
    const motion::Pose pose = path.pose(time_s);
    ASSERT_FALSE(collision::collides(c.index, corners_C, pose)) << "at " << time_s;
    const auto gap_m =
        collision::clearance_m(c.index, corners_C, pose, c.detect.clearance_m + 1e-3);
    ASSERT_GE(gap_m.value_or(1.0), c.detect.clearance_m) << "at " << time_s;
  }
}

TEST(Relaxation, StaysFreeKeepsKeyframesAndIsNoWorse) {
  Draw draw(9901);  // among them one that keeping away from what is near makes worse
  int better = 0;
  constexpr int kRuns = testing::runs(70);
  for (int run = 0; run < kRuns; ++run) {
    const Swing swing = random_swing(draw);
    for (const Objective objective : kRelaxedObjectives) {
      const Relaxed result = relaxed_fully(swing.c, *swing.free, swing.ends, objective);
      expect_free(swing.c, result.candidate.path);
      expect_keyframes_kept(swing.c, result.candidate.path);
      const double before = swing.c.value(swing.free->offsets, swing.ends, objective);
      const double after = swing.c.value(result.offsets, swing.ends, objective);
      if (objective != Objective::kSafest) {
        EXPECT_LE(after, before * (1.0 + 1e-12)) << run;
        better += after < 0.9 * before ? 1 : 0;
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(better, 3 * kRuns * 8 / 10) << "most of what swings widely is easy to improve";
}

TEST(Relaxation, GivesTheCandidateOfItsOffsets) {
  Draw draw(4402);
  for (int run = 0; run < 10; ++run) {
    const Swing swing = random_swing(draw);
    const Relaxed result = relaxed_fully(swing.c, *swing.free, swing.ends, Objective::kClosest);
    const CubicPath expected = motion::with_bumps(
        swing.c.problem.path, std::vector{bumps_for(result.offsets, swing.ends)});
    ASSERT_EQ(result.candidate.path.pieces.size(), expected.pieces.size());
    for (int i = 0; i <= 100; ++i) {
      const double time_s = std::lerp(expected.begin_s(), expected.end_s(), i / 100.0);
      // The rounding from keeping keyframes.
      EXPECT_LT((result.candidate.path.at(time_s).position - expected.at(time_s).position).norm(),
                1e-13);
    }
  }
}

TEST(Relaxation, IsTheSameBitForBitEveryTime) {
  Draw draw(4403);
  for (int run = 0; run < 8; ++run) {
    const Swing swing = random_swing(draw);
    for (const Objective objective :
         {Objective::kShortest, Objective::kSmoothest, Objective::kSafest}) {
      const Relaxed once = relaxed_fully(swing.c, *swing.free, swing.ends, objective);
      const Relaxed again = relaxed_fully(swing.c, *swing.free, swing.ends, objective);
      expect_same(once.candidate.path, again.candidate.path);
    }
  }
}

TEST(Relaxation, WithoutStepsChangesNothing) {
  Draw draw(4404);
  const Swing swing = random_swing(draw);
  const Relaxed result = relaxed_fully(swing.c, *swing.free, swing.ends, Objective::kClosest, 0);
  expect_same(result.candidate.path, swing.free->candidate.path);
  FreeSpace space = swing.c.space();
  const Improvement improvement{Objective::kClosest};
  base::Budget budget(0);
  EXPECT_FALSE(polished(swing.c.problem, kKnots, improvement, budget, space, Deadline::never()));
  EXPECT_EQ(budget.left(), 0);
}

TEST(Relaxation, AfterTheDeadlineChangesNothingAndDoesNoSteps) {
  Draw draw(4405);
  const Swing swing = random_swing(draw);
  FreeSpace space = swing.c.space();
  const Improvement improvement{Objective::kClosest};
  base::Budget budget(kEnoughSteps);
  const Relaxed result = relaxed(swing.c.problem, *swing.free, swing.ends, improvement, budget,
                                 space, Deadline::after_s(0.0));
  expect_same(result.candidate.path, swing.free->candidate.path);
  EXPECT_EQ(budget.left(), kEnoughSteps);
}

TEST(Relaxation, DoesNoMoreStepsThanThereAreAndLeavesTheRest) {
  Draw draw(4406);
  int stopped_early = 0;
  for (int run = 0; run < 20; ++run) {
    const Swing swing = random_swing(draw);
    for (const int steps : {1, 3, kEnoughSteps}) {
      FreeSpace space = swing.c.space();
      const Improvement improvement{Objective::kSmoothest};
      base::Budget budget(steps);
      relaxed(swing.c.problem, *swing.free, swing.ends, improvement, budget, space,
              Deadline::never());
      EXPECT_GE(budget.left(), 0);
      EXPECT_LT(budget.left(), steps);
      stopped_early += steps == kEnoughSteps && budget.left() > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(stopped_early, 20) << "one correction must not use up what all have";
}

/// Largest share of the possible gain that steps may leave, as they end when they gain little. That
/// is more where their form only bounds the objective.
double largest_share_left(Objective objective) {
  if (objective == Objective::kClosest) return 0.02;
  return objective == Objective::kShortest ? 4e-3 : 1e-3;
}

// Without obstacles the result is the objective's minimum.
TEST(Relaxation, ReachesTheMinimumInTheOpen) {
  RelaxationCase c;
  testing::add_cuboid(c.mesh, {90, 90, 90}, {91, 91, 91});
  c.build();
  c.problem = testing::problem_of_leg(
      {at(0, {0, 0, 3}), at(1, {0.5, 0, 1}), at(3, {0, 0.3, -1}), at(4, {0, 0, -3})}, 1);
  // Another path than the original, as a row that adds nothing is no correction.
  const motion::BumpRow bump{
      motion::KnotRow::about(2.0, 0.3, nullptr), 2, {{{0.2, 0, 0}, geometry::Vec4::Zero()}}};
  c.problem.original = motion::with_bumps(c.problem.path, std::vector{bump});
  const std::optional<Relaxed> free =
      correction_with(c, lifted(c.problem, 16, {0, 2, 0}), Ends::kFree);
  ASSERT_TRUE(free);
  for (const Objective objective : kRelaxedObjectives) {
    const Relaxed result = relaxed_fully(c, *free, Ends::kFree, objective);
    const Closeness closeness = c.space().closeness();
    const double lever_m = 4.0 * (objective == Objective::kClosest ? closeness.turn_lever_m
                                                                   : c.space().ball_radius_m());
    const FreeCoefficients coefficients(c.problem, free->offsets.knots, Ends::kFree);
    StackedPoints best = coefficients.variables_of(free->offsets, lever_m);
    for (int i = 0; i < 200; ++i) {
      best = SmoothingForm(c.problem, coefficients, objective, lever_m, closeness, best).minimum();
    }
    const double start = c.value(free->offsets, Ends::kFree, objective);
    const double reached = c.value(result.offsets, Ends::kFree, objective);
    const double least = c.value(coefficients.offsets_of(best, lever_m), Ends::kFree, objective);
    EXPECT_LE(reached - least, largest_share_left(objective) * (start - least))
        << static_cast<int>(objective);
  }
}

// The camera flies along a corridor close to one wall.
TEST(Relaxation, SafestGoesAwayFromWalls) {
  RelaxationCase c;
  testing::add_cuboid(c.mesh, {-0.7, -9, -4}, {-0.6, 9, 4});
  testing::add_cuboid(c.mesh, {0.6, -9, -4}, {0.7, 9, 4});
  c.build();
  c.problem = testing::problem_of_leg({at(0, {0, 0, 3}), at(6, {0, 0, -3})}, 0);
  const std::optional<Relaxed> free =
      correction_with(c, lifted(c.problem, 12, {0.45, 0, 0}), Ends::kFree);
  ASSERT_TRUE(free);
  const double before_m = least_gap_m(c, free->candidate.path, 0.0, 6.0, 2000);
  const Relaxed result = relaxed_fully(c, *free, Ends::kFree, Objective::kSafest);
  const double after_m = least_gap_m(c, result.candidate.path, 0.0, 6.0, 2000);
  EXPECT_LT(before_m, 0.06);
  // In the centre there is half a metre to either side; three radii of the ball count as enough.
  EXPECT_GT(after_m, 0.3);
  // Bending alone would lead there, too: near a keyframe close to a wall, it leads the other way.
  c.problem = testing::problem_of_leg({at(0, {0.4, 0, 3}), at(6, {0.4, 0, -3})}, 0);
  const std::optional<Relaxed> straight =
      correction_with(c, lifted(c.problem, 12, {0.0, 0.1, 0}), Ends::kFree);
  ASSERT_TRUE(straight);
  const Relaxed bent = relaxed_fully(c, *straight, Ends::kFree, Objective::kSafest);
  EXPECT_LT(bent.candidate.path.at(3.0).position.x(), 0.25);
  EXPECT_NEAR(least_gap_m(c, straight->candidate.path, 1.5, 4.5, 500), 0.1, 1e-3);
  EXPECT_GT(least_gap_m(c, bent.candidate.path, 1.5, 4.5, 500), 0.2);
}

TEST(Relaxation, ShortestShortensUpToWhatIsInTheWay) {
  RelaxationCase c;
  testing::add_cuboid(c.mesh, {-3, -3, -0.2}, {3, 0.4, 0.2});
  c.build();
  c.policy.rule = OrientationRule::kKeep;  // tilted, it could go lower
  c.problem = testing::problem_of_leg({at(0, {0, 0, 2}), at(6, {0, 0, -2})}, 0);
  const std::optional<Relaxed> free =
      correction_with(c, lifted(c.problem, 16, {0.8, 2.0, 0}), Ends::kFree);
  ASSERT_TRUE(free);
  const Relaxed result = relaxed_fully(c, *free, Ends::kFree, Objective::kShortest);
  // The lower edge of the quadrilateral is 0.1 in front of the eye and passes straight over the
  // edges of the block: at least that far, and little further.
  const double top_m = 0.4 + std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
  const double least_m = std::hypot(1.7, top_m) + 0.4 + std::hypot(1.9, top_m);
  EXPECT_GT(length_m(free->candidate.path), 1.2 * least_m);
  EXPECT_GT(length_m(result.candidate.path), least_m);
  EXPECT_LT(length_m(result.candidate.path), 1.03 * least_m);
  EXPECT_GT(least_gap_m(c, result.candidate.path, 0.0, 6.0, 4000), 0.0);
}

// Plates without thickness across the path, each between two samples: at no sample is the camera,
// which is as thin, near one of them.
TEST(Relaxation, MindsWhatSlipsThroughBetweenSamples) {
  for (const Objective objective : kRelaxedObjectives) {
    RelaxationCase c;
    constexpr int kFewKnots = 8;
    c.policy.rule = OrientationRule::kKeep;
    c.problem = testing::problem_of_leg({at(0, {0, 0, 2.1}), at(8, {0, 0, -1.9})}, 0);
    // The centre is a knot; samples are a quarter of a second from knots, an eighth of a metre.
    const double z = c.problem.path.at(4.0).position.z() - 0.1;
    testing::add_triangle(c.mesh, {-0.02, -4, z}, {0.02, -4, z}, {0, 0.2, z});
    c.build();
    const std::optional<Relaxed> free =
        correction_with(c, lifted(c.problem, kFewKnots, {0, 0.9, 0}), Ends::kFree);
    ASSERT_TRUE(free);
    const Relaxed result = relaxed_fully(c, *free, Ends::kFree, objective);
    expect_keyframes_kept(c, result.candidate.path);
    EXPECT_FALSE(collision::first_collision({collision::Obstacles(c.index), c.body, c.detect},
                                            result.candidate.path.path(), 0.0, 8.0,
                                            Deadline::never())
                     .interval);
    // The path passes above the plate, lower than at its beginning: it came down to it.
    const CubicPath& path = result.candidate.path;
    const double edge_m = 0.2 + std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
    int passing = 0;
    for (int i = 0; i <= 100000; ++i) {
      const Vec3 eye = path.at(8.0 * i / 100000).position;
      // The quadrilateral reaches 0.1 to either side. Up to there the path passes over the tip; a
      // little further aside it passes beside the tip.
      if (std::abs(eye.z() - 0.1 - z) > 1e-4 || std::abs(eye.x()) > 0.15) continue;
      ++passing;
      ASSERT_GT(eye.y(), edge_m - (std::abs(eye.x()) > 0.1 ? 0.1 : 0.04));
      if (objective != Objective::kSafest) {
        ASSERT_LT(eye.y(), 0.5);
      }
    }
    EXPECT_GT(passing, 0);
    const double before = c.value(free->offsets, Ends::kFree, objective);
    EXPECT_LT(c.value(result.offsets, Ends::kFree, objective), before);
  }
}

TEST(Relaxation, PolishesWhatIsWornAndNothingElse) {
  Draw draw(4407);
  int found = 0;
  constexpr int kRuns = 20;
  for (int run = 0; run < kRuns; ++run) {
    Swing swing = random_swing(draw);
    RelaxationCase& c = swing.c;
    c.problem.path = swing.free->candidate.path;
    // On coarser knots than before; some wide swings can only get worse on these.
    FreeSpace space = c.space();
    const Improvement improvement{Objective::kSmoothest};
    base::Budget budget(kEnoughSteps);
    const std::optional<Candidate> better =
        polished(c.problem, kKnots, improvement, budget, space, Deadline::never());
    EXPECT_LE(budget.left(), kEnoughSteps);
    if (!better) continue;
    ++found;
    expect_free(c, better->path);
    expect_keyframes_kept(c, better->path);
    EXPECT_LT(
        motion::measure(better->path.path(), c.problem.path.path()).bending_energy_m2_per_s3,
        motion::measure(c.problem.path.path(), c.problem.path.path()).bending_energy_m2_per_s3)
        << run;
  }
  EXPECT_GT(found, kRuns / 2);
}

TEST(Relaxation, GetsFarWhereTurningIsLimited) {
  Draw draw(4408);
  int better = 0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    Swing swing = random_swing(draw, 0.15);
    const Relaxed result = relaxed_fully(swing.c, *swing.free, swing.ends, Objective::kSmoothest);
    const CubicPath& path = result.candidate.path;
    for (int i = 0; i <= 500; ++i) {
      const double time_s = std::lerp(path.begin_s(), path.end_s(), i / 500.0);
      ASSERT_GE(rule_room(swing.c.policy, path.pose(time_s), swing.c.problem.original.pose(time_s)),
                -1e-9)
          << run;
    }
    const double before = swing.c.value(swing.free->offsets, swing.ends, Objective::kSmoothest);
    const double after = swing.c.value(result.offsets, swing.ends, Objective::kSmoothest);
    better += after < 0.5 * before ? 1 : 0;
  }
  // Steps that break the rule are refused as a whole.
  EXPECT_GT(better, kRuns * 9 / 10);
}

// The objective's minimum is a hundredth of the ball's radius above a block that is too far away to
// be a contact at first; one step would lead there.
TEST(Relaxation, LeavesAGapBesideWhatItDidNotKnow) {
  RelaxationCase c;
  c.policy.rule = OrientationRule::kKeep;
  const double radius_m = c.space().ball_radius_m();
  const double low_m = -std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
  testing::add_cuboid(c.mesh, {-3, -3, -0.3}, {3, low_m - 0.01 * radius_m, 0.3});
  c.build();
  c.problem = testing::problem_of_leg({at(0, {0, 0, 4}), at(8, {0, 0, -4})}, 0);
  const std::optional<Relaxed> free =
      correction_with(c, lifted(c.problem, 8, {0, 1.5 * radius_m, 0}), Ends::kFree);
  ASSERT_TRUE(free);
  const Relaxed result = relaxed_fully(c, *free, Ends::kFree, Objective::kSmoothest, 1);
  const auto gap_m = [&](const Relaxed& of) {
    return least_gap_m(c, of.candidate.path, 0.0, 8.0, 4000);
  };
  EXPECT_LT(gap_m(result), gap_m(*free) - 0.1 * radius_m);
  EXPECT_GT(gap_m(result), 0.02 * radius_m);
}

// The next keyframe is so close that the coefficients which keep the one before would reach it.
TEST(Relaxation, PolishesNextToAShortGap) {
  RelaxationCase c;
  testing::add_cuboid(c.mesh, {90, 90, 90}, {91, 91, 91});
  c.build();
  c.problem = testing::problem_of_leg(
      {at(0, {0, 0, 3}), at(6, {0, 0, -3}), at(6.5, {0, 0, -3.5}), at(8, {0, 0, -5})}, 0);
  c.problem.path =
      correction_with(c, lifted(c.problem, 12, {0, 0.5, 0}), Ends::kFixed).value().candidate.path;
  FreeSpace space = c.space();
  const Improvement improvement{.objective = Objective::kShortest, .worth = 0.01};
  base::Budget budget(kEnoughSteps);
  const std::optional<Candidate> better =
      polished(c.problem, kKnots, improvement, budget, space, Deadline::never());
  ASSERT_TRUE(better);
  expect_keyframes_kept(c, better->path);
  constexpr double kStraight_m = 6.5;
  EXPECT_LT(length_m(better->path) - kStraight_m, 0.2 * (length_m(c.problem.path) - kStraight_m));
}

TEST(Relaxation, PolishesNothingThatIsAsGoodAsItGets) {
  RelaxationCase c;
  testing::add_cuboid(c.mesh, {90, 90, 90}, {91, 91, 91});
  c.build();
  c.problem = testing::problem_of_leg({at(0, {0, 0, 3}), at(2, {0.5, 0, 1}), at(4, {0, 0, -1})}, 0);
  FreeSpace space = c.space();
  const Improvement improvement{Objective::kClosest};
  base::Budget budget(kEnoughSteps);
  EXPECT_FALSE(polished(c.problem, kKnots, improvement, budget, space, Deadline::never()));
  EXPECT_EQ(budget.left(), kEnoughSteps);
}

}  // namespace
}  // namespace camway::correction
