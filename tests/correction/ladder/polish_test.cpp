// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/polish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/motion/path/measures.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;
using motion::CubicPath;

double length_m(const CubicPath& path) {
  const motion::Path segments = path.path();
  return motion::measure(segments, segments).length_m;
}

double ball_radius_m(const LadderCase& c) { return FreeSpace(c.query()).ball_radius_m(); }

collision::PathClearance clearance_of(const LadderCase& c, const CubicPath& path) {
  return collision::path_clearance(c.query().obstacles, path.path(), c.body, Deadline::never())
      .value();
}

/// A thin plate at z = 0 across the way of the camera, which keeps its orientation. It ends at
/// `top_m` and is wide and deep, so that the way over it is the least. The camera flies level in
/// `duration_s` and crosses the plate after `share` of the time.
LadderCase over_a_plate(double top_m, double share, double length_m, double duration_s) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-20, -20, -0.005}, {20, top_m, 0.005});
  // The near quadrilateral is 0.1 in front of the eye.
  const double begin_m = share * length_m + 0.1;
  LadderCase c =
      case_with(mesh, {at(0, {0, 0, begin_m}), at(duration_s, {0, 0, begin_m - length_m})});
  c.options.orientation.rule = OrientationRule::kKeep;
  return c;
}

/// Height of the eye at which the lower edge of the near quadrilateral is at `edge_m`.
double eye_over_m(double edge_m) {
  return edge_m + std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
}

// The least bending of a curve that is at rest at both ends of the height and passes a height h
// after a share s of the time T is that of the natural spline: 3·h²/(T³·s²·(1-s)²), a beam with a
// load. The path may cross the plate at another time than as interpolated, for that a little more
// is allowed.
TEST(Polish, SmoothestBendsHardlyMoreThanIsNeededOverAPlate) {
  testing::Random random(4541);
  for (int run = 0; run < 12; ++run) {
    const double top_m = random.uniform(0.2, 0.5);
    const double share = random.uniform(0.35, 0.65);
    const double duration_s = random.uniform(3.0, 8.0);
    const LadderCase c = over_a_plate(top_m, share, 4.0, duration_s);
    ASSERT_FALSE(c.collisions(c.path()).empty());
    const LadderResult smoothest = corrected_for(Objective::kSmoothest, c);
    EXPECT_TRUE(c.collisions(smoothest.path).empty()) << run;
    const double height_m = eye_over_m(top_m);
    // The least over all times of the crossing is that in the middle.
    const double least = 48.0 * height_m * height_m / std::pow(duration_s, 3.0);
    const double at_that_time = least / std::pow(4.0 * share * (1.0 - share), 2.0);
    const double bending = bending_energy(smoothest.path);
    EXPECT_GT(bending, 0.99 * least) << run;
    EXPECT_LT(bending, 1.1 * at_that_time) << run;
  }
}

// The shortest way over the plate is two straight lines.
TEST(Polish, ShortestIsHardlyLongerThanTheLinesOverAPlate) {
  testing::Random random(4542);
  for (int run = 0; run < 12; ++run) {
    const double top_m = random.uniform(0.4, 0.9);
    const double share = random.uniform(0.3, 0.7);
    const LadderCase c = over_a_plate(top_m, share, 4.0, 5.0);
    const LadderResult shortest = corrected_for(Objective::kShortest, c);
    EXPECT_TRUE(c.collisions(shortest.path).empty()) << run;
    const double height_m = eye_over_m(top_m);
    const double least_m =
        std::hypot(share * 4.0, height_m) + std::hypot((1.0 - share) * 4.0, height_m);
    const double reached_m = length_m(shortest.path);
    const double closest_m = length_m(corrected_for(Objective::kClosest, c).path);
    EXPECT_GT(reached_m, least_m) << run;
    // Most of the possible gain.
    EXPECT_LT(reached_m - least_m, 0.35 * (closest_m - least_m)) << run;
  }
}

// Between samples a curve comes nearer to a plate than at them. Every second camera starts beside a
// wall, so that no path has much distance; some must keep a clearance from the plate, too.
TEST(Polish, KeepsTheDistanceThatCountsAsTight) {
  testing::Random random(4543);
  int polished = 0;
  for (int run = 0; run < 20; ++run) {
    const double clearance_m = run % 4 == 2 ? 0.3 : 0.0;
    const double top_m = random.uniform(0.3, 0.7) - clearance_m;
    LadderCase c = over_a_plate(top_m, random.uniform(0.3, 0.7), 4.0, 5.0);
    c.detect.clearance_m = clearance_m;
    const double tight_m = kTightGap * ball_radius_m(c);
    if (run % 2 == 1) {
      // The near quadrilateral reaches 0.1 to either side.
      const double wall_m = 0.1 + random.uniform(0.1, 0.9) * tight_m;
      testing::add_cuboid(c.mesh, {-wall_m - 0.1, -20, -20}, {-wall_m, 20, 20});
      c.index = scene::SceneIndex::build(c.mesh);
    }
    const LadderResult closest = corrected_for(Objective::kClosest, c);
    ASSERT_TRUE(c.collisions(closest.path).empty()) << run;
    const double before_m = clearance_of(c, closest.path).lower_bound_m - clearance_m;
    for (const Objective objective : {Objective::kShortest, Objective::kSmoothest}) {
      const LadderResult result = corrected_for(objective, c);
      polished += result.is_polished ? 1 : 0;
      const double kept_m = std::min(0.95 * before_m, tight_m);
      EXPECT_GE(clearance_of(c, result.path).upper_bound_m, clearance_m + kept_m) << run;
    }
  }
  EXPECT_GT(polished, 30);
}

// Plates between samples, none of which is in the way of the least bend over the highest of them.
TEST(Polish, SmoothestGetsFarPastManyThinPlates) {
  testing::Random random(4545);
  for (int run = 0; run < 8; ++run) {
    constexpr double kTop_m = 0.5;
    constexpr double kDuration_s = 5.0;
    LadderCase c = over_a_plate(kTop_m, 0.5, 4.0, kDuration_s);
    for (int i = 0; i < 14; ++i) {
      const double z = random.uniform(-1.2, 1.2);
      const double share = 0.5 + std::abs(z) / 4.0;
      // The natural spline over the middle, less a margin.
      const double rest = 1.0 - share;
      const double below_m = kTop_m * (3.0 * rest - 4.0 * rest * rest * rest) - 0.15;
      testing::add_cuboid(c.mesh, {-20, -20, z - 0.001}, {20, below_m, z + 0.001});
    }
    c.index = scene::SceneIndex::build(c.mesh);
    const LadderResult smoothest = corrected_for(Objective::kSmoothest, c);
    EXPECT_TRUE(c.collisions(smoothest.path).empty()) << run;
    const double height_m = eye_over_m(kTop_m);
    const double least = 48.0 * height_m * height_m / std::pow(kDuration_s, 3.0);
    EXPECT_LT(bending_energy(smoothest.path), 1.25 * least) << run;
  }
}

TEST(Polish, IsTheSameBitForBitEveryTime) {
  testing::Random random(4544);
  for (int run = 0; run < 4; ++run) {
    const LadderCase c = over_a_plate(random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), 4.0, 5.0);
    for (const Objective objective : {Objective::kShortest, Objective::kSmoothest}) {
      const CubicPath once = corrected_for(objective, c).path;
      const CubicPath again = corrected_for(objective, c).path;
      ASSERT_EQ(once.pieces.size(), again.pieces.size());
      for (std::size_t i = 0; i < once.pieces.size(); ++i) {
        EXPECT_EQ(once.pieces[i].t0_s, again.pieces[i].t0_s);
        EXPECT_EQ(once.pieces[i].position, again.pieces[i].position);
        EXPECT_EQ(once.pieces[i].image, again.pieces[i].image);
      }
    }
  }
}

}  // namespace
}  // namespace camway::correction
