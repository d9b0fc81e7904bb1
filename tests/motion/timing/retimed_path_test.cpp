// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/retimed_path.h"

#include "tests/motion/smooth_joins.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using testing::Random;

CubicPath random_path(Random& random, int count) {
  return interpolate_cubic(test::with_times(test::random_poses(random, count)));
}

constexpr RateLimits kBiting{0.5, 0.5, 0.5};

/// Returns the largest distance of `slowed` from the path that it was made of, at the same given
/// time.
double deviation_m(const CubicPath& path, const CubicPath& slowed, const TimeLaw& law) {
  double largest_m = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double given_s = path.begin_s() + (path.end_s() - path.begin_s()) * i / 2000.0;
    const Pose was = path.pose(given_s);
    const Pose is = slowed.pose(law.new_time_s(given_s));
    largest_m = std::max({largest_m, (was.position - is.position).norm(),
                          was.orientation.angularDistance(is.orientation)});
  }
  return largest_m;
}

TEST(RetimedPath, IsSmoothAndMeetsThePathAtTheKnots) {
  Random random(3301);
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(::testing::Message() << "round " << round);
    const CubicPath path = random_path(random, random.integer(2, 9));
    const TimeLaw law = TimeLaw::within(path.path(), kBiting, random.log_uniform(0.02, 0.5));
    ASSERT_GT(law.slow_down(), 1.0);
    const CubicPath slowed = retimed(path, law);
    // The rounding of the solution of a tridiagonal system, instead of a few sums.
    test::expect_smooth(slowed.path(), 8.0);
    EXPECT_EQ(slowed.begin_s(), path.begin_s());
    for (const CubicPiece& piece : path.pieces) {
      const CubicPoint at = slowed.at(law.new_time_s(piece.t0_s));
      EXPECT_EQ(at.position, piece.position[0]);
      EXPECT_EQ(at.image, piece.image[0]);
    }
    EXPECT_EQ(slowed.pieces.back().position[3], path.pieces.back().position[3]);
  }
}

// For a smooth law the deviation falls with the fourth power of the step. But the law changes from
// braking to accelerating within one step, and the spline oscillates there in the long pieces next
// to it.
TEST(RetimedPath, StraysLessTheShorterTheSteps) {
  Random random(3302);
  double coarse_m = 0.0;
  double fine_m = 0.0;
  for (int round = 0; round < 20; ++round) {
    const CubicPath path = random_path(random, 5);
    const TimeLaw coarse = TimeLaw::within(path.path(), kBiting, 0.08);
    const TimeLaw fine = TimeLaw::within(path.path(), kBiting, 0.02);
    coarse_m += deviation_m(path, retimed(path, coarse), coarse) / 20.0;
    fine_m += deviation_m(path, retimed(path, fine), fine) / 20.0;
  }
  EXPECT_LT(coarse_m, 1e-3);
  EXPECT_LT(fine_m, coarse_m / 8.0) << coarse_m;
}

TEST(RetimedPath, IsTheSamePathByTheLawThatChangesNothing) {
  Random random(3303);
  const CubicPath path = random_path(random, 7);
  const TimeLaw law = TimeLaw::within(path.path(), {1e6, 1e6, 1e6}, 0.1);
  EXPECT_LT(deviation_m(path, retimed(path, law), law), 1e-12);
}

TEST(RetimedPath, StretchedKeepsEveryControlPoint) {
  Random random(3304);
  const CubicPath path = random_path(random, 7);
  const TimeLaw law = TimeLaw::uniform({path.begin_s(), path.end_s()}, 1.7);
  const CubicPath slower = with_new_times(path, law);
  ASSERT_EQ(slower.pieces.size(), path.pieces.size());
  for (std::size_t i = 0; i < path.pieces.size(); ++i) {
    EXPECT_EQ(slower.pieces[i].position, path.pieces[i].position);
    EXPECT_EQ(slower.pieces[i].image, path.pieces[i].image);
    EXPECT_EQ(slower.pieces[i].t0_s, law.new_time_s(path.pieces[i].t0_s));
    EXPECT_EQ(slower.pieces[i].t1_s, law.new_time_s(path.pieces[i].t1_s));
  }
}

}  // namespace
}  // namespace camway::motion
