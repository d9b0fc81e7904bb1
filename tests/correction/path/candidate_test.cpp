// SPDX-License-Identifier: MIT
#include "daemon/correction/path/candidate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "daemon/collision/detect.h"
#include "daemon/correction/path/guide.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;
using collision::CollisionInterval;
using motion::BumpRow;
using motion::CubicPath;
using motion::CubicPoint;

/// Returns a path at x = 0 with z from 4 to -4, keyframes every 2 s.
CubicPath path_along_z() {
  std::vector<motion::Keyframe> keyframes;
  for (int i = 0; i <= 4; ++i)
    keyframes.push_back({2.0 * i, {Vec3(0, 0, 4.0 - 2.0 * i), Quat::Identity()}});
  return motion::interpolate_cubic(keyframes);
}

/// Returns the problem of the interval from 2 to 4 s, as the ladder makes it.
Problem middle_problem() {
  Problem problem;
  problem.path = path_along_z().around(0.0, 6.0);
  problem.original = problem.path;
  problem.keyframes_s = {0.0, 2.0, 4.0, 6.0};
  problem.leg = 1;
  problem.has_path_begin = true;
  problem.interval = {2.5, 3.5};
  return problem;
}

/// Returns a bump of this height about the middle of the interval, with its support inside.
BumpRow single(const Vec3& height) {
  return {{2.0, 4.0, 4}, 2, {{height / motion::kBumpPeak, Vec4::Zero()}}};
}

/// Returns random coefficients within the interval, with rotation.
BumpRow any_row(testing::Random& random) {
  std::uniform_real_distribution<double> off(-0.5, 0.5);
  BumpRow row{{2.0, 4.0, 8}, 2, {}};
  for (int k = 2; k <= 6; ++k) {
    const double x = off(random);
    const double y = off(random);
    const double turn = off(random);
    row.bumps.push_back({Vec3(x, y, 0), Vec4(0, 0, 0, 0.3 * turn)});
  }
  return row;
}

/// Adds a plate that the quadrilateral meets with its inside while it passes `z_m`.
void add_plate(scene::Mesh& mesh, double z_m) {
  const Vec3 low(0, -5, z_m - 0.1);
  const Vec3 high(0, 5, z_m + 0.1);
  testing::add_triangle(mesh, low, {0, -5, z_m + 0.1}, high);
  testing::add_triangle(mesh, low, high, {0, 5, z_m - 0.1});
}

/// Returns a plate at the path's place at 3 s.
SearchScene plate_in_the_way() {
  scene::Mesh mesh;
  add_plate(mesh, 1.0);
  return SearchScene(std::move(mesh));
}

double least_distance_m(const SearchScene& scene, const CubicPath& path, double from_s,
                        double to_s) {
  constexpr int kSteps = 2000;
  double least_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i)
    least_m =
        std::min(least_m, scene.distance_m(path.pose(std::lerp(from_s, to_s, double(i) / kSteps))));
  return least_m;
}

TEST(Attempt, TakesWhatIsFreeAndNothingElse) {
  const SearchScene scene = plate_in_the_way();
  const FreeSpace space = scene.space();
  const Problem problem = middle_problem();
  EXPECT_TRUE(attempt(problem, {single({0.3, 0, 0})}, space, Deadline::never()).candidate);
  const Attempt low = attempt(problem, {single({0.05, 0, 0})}, space, Deadline::never());
  EXPECT_FALSE(low.candidate);
  ASSERT_TRUE(low.collision);
  EXPECT_GT(low.collision->t_end_s, 2.5);
  EXPECT_LT(low.collision->t_begin_s, 3.5);
}

// The row leads round the plate at 1 s. The plate at 3 s is beyond its end.
TEST(Attempt, AlsoFreesTheIntervalWhereNoRowReaches) {
  scene::Mesh mesh;
  add_plate(mesh, 3.0);
  add_plate(mesh, 1.0);
  const SearchScene scene(std::move(mesh));
  const FreeSpace space = scene.space();
  Problem problem = middle_problem();
  const BumpRow early{{0.0, 2.0, 4}, 2, {{Vec3(0.3, 0, 0) / motion::kBumpPeak, Vec4::Zero()}}};
  const Attempt tried = attempt(problem, {early}, space, Deadline::never());
  EXPECT_FALSE(tried.candidate);
  ASSERT_TRUE(tried.collision);
  EXPECT_GT(tried.collision->t_begin_s, early.end_s());
  EXPECT_GE(tried.collision->t_end_s, tried.collision->t_begin_s);
  EXPECT_FALSE(free_candidate(problem, {early}, space, Deadline::never()));
  problem.interval = {0.5, 1.5};
  EXPECT_TRUE(attempt(problem, {early}, space, Deadline::never()).candidate);
}

TEST(Attempt, AgreesWithSamplesOfEveryTriangle) {
  testing::Random random(1);
  const Problem problem = middle_problem();
  int taken = 0;
  int refused = 0;
  for (int run = 0; run < 120; ++run) {
    scene::Mesh mesh = testing::scattered_triangles(random, 12, 0.25);
    for (Vec3& vertex : mesh.vertices) vertex.z() += 1.0;
    SearchScene scene(std::move(mesh));
    scene.detect.clearance_m = run % 2 == 0 ? 0.0 : 0.03;
    const FreeSpace space = scene.space();
    const BumpRow row = any_row(random);
    const CubicPath path = motion::with_bumps(problem.path, std::array{row});
    const Attempt tried = attempt(problem, {row}, space, Deadline::never());
    EXPECT_NE(tried.candidate.has_value(), tried.collision.has_value());
    if (tried.candidate) {
      ++taken;
      EXPECT_GT(least_distance_m(scene, path, row.begin_s(), row.end_s()),
                scene.detect.clearance_m);
    } else {
      ++refused;
      // It collides there, or comes nearer than the search can resolve.
      EXPECT_LT(least_distance_m(scene, path, tried.collision->t_begin_s - 1e-3,
                                 tried.collision->t_end_s + 1e-3),
                scene.detect.clearance_m + scene.detect.tolerance_m);
    }
  }
  EXPECT_GT(taken, 15);
  EXPECT_GT(refused, 15);
}

// Pieces beyond the row keep their bits. Of a piece that the row cuts, the part beyond differs by
// the rounding of cutting only.
TEST(Attempt, KeepsKeyframesAndWhatIsBeyond) {
  testing::Random random(2);
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  const Problem problem = middle_problem();
  const BumpRow within = any_row(random);
  // A row over both keyframes that is zero at them up to rounding.
  BumpRow across{{2.0, 4.0, 8}, -1, {}};
  const CubicPoint a{Vec3(0.3, 0.1, 0.7), Vec4::Zero()};
  across.bumps = {a, holding(across.knots, 0, a, a), a};
  for (const BumpRow& row : {within, across}) {
    const Attempt tried = attempt(problem, {row}, space, Deadline::never());
    ASSERT_TRUE(tried.candidate);
    const CubicPath& now = tried.candidate->path;
    for (const double time_s : problem.keyframes_s) {
      EXPECT_EQ(now.at(time_s).position, problem.path.at(time_s).position);
      EXPECT_EQ(now.at(time_s).image, problem.path.at(time_s).image);
    }
    for (double time_s = 0.0; time_s <= 6.0; time_s += 0.01) {
      const bool is_changed = time_s > row.begin_s() && time_s < row.end_s();
      if (is_changed) continue;
      EXPECT_LT((now.at(time_s).position - problem.path.at(time_s).position).norm(), 1e-14);
      if (time_s > row.begin_s() - 2.0 && time_s < row.end_s() + 2.0) continue;
      EXPECT_EQ(now.at(time_s).position, problem.path.at(time_s).position);
    }
    EXPECT_GT((now.at(row.knots.knot_s(row.first)).position -
               problem.path.at(row.knots.knot_s(row.first)).position)
                  .norm(),
              1e-3);
  }
}

TEST(Attempt, RefusesWhatMovesAKeyframe) {
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  for (const double size : {1.0, 1e-3, 1e-9}) {
    // A single bump whose shoulder is at the keyframe.
    const BumpRow moves{{2.0, 4.0, 4}, 1, {{Vec3(size, 0, 0), Vec4::Zero()}}};
    const BumpRow turns{{2.0, 4.0, 4}, 1, {{Vec3::Zero(), Vec4(0, size, 0, 0)}}};
    EXPECT_FALSE(attempt(middle_problem(), {moves}, space, Deadline::never()).candidate);
    EXPECT_FALSE(attempt(middle_problem(), {turns}, space, Deadline::never()).candidate);
  }
}

// A row that extends beyond the path of the problem would change an unknown part; it is refused
// unless it is zero there.
TEST(Attempt, StaysWithinItsPartOfThePath) {
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  const CubicPoint a{Vec3(0.1, 0, 0), Vec4::Zero()};
  // With knots every second: from a second before the beginning to 3 s, and from 3 s to a second
  // after the end; zero at all keyframes.
  const auto row_from = [&](int first) {
    const motion::KnotRow knots{2.0, 4.0, 2};
    return BumpRow{knots, first, {a, holding(knots, first + 1, a, a), a}};
  };
  const BumpRow early = row_from(-2);  // 0 s, which is a keyframe: its own value has to be zero
  EXPECT_FALSE(attempt(middle_problem(), {early}, space, Deadline::never()).candidate);
  BumpRow over_begin{{0.0, 2.0, 8}, -1, {a, CubicPoint{}, a}};
  over_begin.bumps[1] = holding(over_begin.knots, 0, a, a);
  BumpRow over_end{{4.0, 6.0, 8}, 7, {a, CubicPoint{}, a}};
  over_end.bumps[1] = holding(over_end.knots, 8, a, a);
  Problem problem = middle_problem();
  EXPECT_TRUE(attempt(problem, {over_begin}, space, Deadline::never()).candidate);
  EXPECT_FALSE(attempt(problem, {over_end}, space, Deadline::never()).candidate);
  problem.has_path_begin = false;
  problem.has_path_end = true;
  EXPECT_FALSE(attempt(problem, {over_begin}, space, Deadline::never()).candidate);
  EXPECT_TRUE(attempt(problem, {over_end}, space, Deadline::never()).candidate);
  EXPECT_FALSE(attempt(problem, {}, space, Deadline::never()).candidate);
}

// A second plate belongs to another correction: its collision may stay, but not grow.
TEST(Attempt, OthersMayStayAndMustNotGrow) {
  scene::Mesh mesh = plate_in_the_way().mesh;
  add_plate(mesh, 1.5);
  const SearchScene scene(std::move(mesh));
  const FreeSpace space = scene.space();
  Problem problem = middle_problem();
  const auto found =
      collision::detect_collisions({collision::Obstacles(scene.index), scene.body, scene.detect},
                                   problem.path.path(), 0.0, 6.0, Deadline::never());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  problem.interval = (*found)[1];
  // The bump is over the plate at z = 1 and hardly reaches the other.
  const BumpRow row{{2.4, 3.6, 4}, 2, {{Vec3(0.6, 0, 0), Vec4::Zero()}}};
  EXPECT_FALSE(attempt(problem, {row}, space, Deadline::never()).candidate);
  problem.foreign_collisions = {(*found)[0]};
  const Attempt tried = attempt(problem, {row}, space, Deadline::never());
  ASSERT_TRUE(tried.candidate);
  EXPECT_GT(least_distance_m(scene, tried.candidate->path, (*found)[0].t_end_s, row.end_s()), 0.0);
  // As if the other collision had been found a little shorter than it is.
  problem.foreign_collisions[0].t_end_s -= 0.02;
  const Attempt grown = attempt(problem, {row}, space, Deadline::never());
  EXPECT_FALSE(grown.candidate);
  ASSERT_TRUE(grown.collision);
  EXPECT_NEAR(grown.collision->t_begin_s, problem.foreign_collisions[0].t_end_s, 1e-9);
}

// If all bumps of a row are zero, nothing is corrected.
TEST(Attempt, RefusesRowsThatChangeNothing) {
  scene::Mesh mesh;
  add_plate(mesh, 1.0);
  const SearchScene scene(mesh);
  for (const int first : {0, 2, 4}) {
    BumpRow nothing = single(Vec3::UnitX());
    nothing.first = first;
    nothing.bumps.clear();
    const FreeSpace space = scene.space();
    EXPECT_FALSE(attempt(middle_problem(), {nothing}, space, Deadline::never()).candidate);
  }
}

TEST(Attempt, WhatCouldNotBeSearchedCountsAsColliding) {
  const SearchScene scene = plate_in_the_way();
  const FreeSpace space = scene.space();
  const Attempt tried =
      attempt(middle_problem(), {single({0.3, 0, 0})}, space, Deadline::after_s(0.0));
  EXPECT_FALSE(tried.candidate);
  EXPECT_TRUE(tried.collision);
}

TEST(NewCollision, IsOutsideOfForeignOnes) {
  scene::Mesh mesh;
  for (const double z_m : {3.0, 1.0, -1.0}) add_plate(mesh, z_m);
  const SearchScene scene(std::move(mesh));
  const FreeSpace space = scene.space();
  Problem problem = middle_problem();
  const auto all =
      collision::detect_collisions({collision::Obstacles(scene.index), scene.body, scene.detect},
                                   problem.path.path(), 0.0, 6.0, Deadline::never());
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 3U);
  for (std::size_t known = 0; known <= 3; ++known) {
    problem.foreign_collisions.assign(all->begin(),
                                      all->begin() + static_cast<std::ptrdiff_t>(known));
    const auto found = new_collision(problem.path, 0.0, 6.0, problem, space, Deadline::never());
    ASSERT_EQ(found.has_value(), known < 3);
    if (known == 3) continue;
    EXPECT_NEAR(found->t_begin_s, (*all)[known].t_begin_s, 2e-3);
  }
  problem.foreign_collisions.clear();
  // Between the plates there is no collision.
  EXPECT_FALSE(new_collision(problem.path, (*all)[0].t_end_s, (*all)[1].t_begin_s, problem, space,
                             Deadline::never()));
}

// The least distance of the changed part is sampled. Bounds and unchanged parts do not count.
TEST(TightPlace, IsFoundWhereTheBodyIsNearerThanTheGap) {
  testing::Random random(3461);
  int near = 0;
  for (int run = 0; run < 50; ++run) {
    scene::Mesh mesh;
    add_plate(mesh, 1.0);
    add_plate(mesh, 3.0);  // beside the unchanged part
    const SearchScene scene(std::move(mesh));
    const FreeSpace space = scene.space();
    const Problem problem = middle_problem();
    const Candidate candidate =
        attempt(problem, {single({random.uniform(0.15, 0.4), 0, 0})}, space, Deadline::never())
            .candidate.value();
    const double least_m = least_distance_m(scene, candidate.path, 2.0, 4.0);
    const double gap_m = random.uniform(0.3, 1.7) * least_m;
    const auto found = tight_place(candidate, gap_m, problem, space, Deadline::never());
    // Samples and decisions at the tolerance.
    if (std::abs(gap_m - least_m) < 0.02 * least_m) continue;
    ASSERT_EQ(found.has_value(), least_m < gap_m) << run;
    if (!found) continue;
    ++near;
    const double middle_s = std::midpoint(found->t_begin_s, found->t_end_s);
    EXPECT_LT(scene.distance_m(candidate.path.pose(middle_s)), 1.02 * gap_m) << run;
  }
  EXPECT_GT(near, 10);
}

}  // namespace
}  // namespace camway::correction
