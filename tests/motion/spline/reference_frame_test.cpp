// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/reference_frame.h"

#include <numbers>

#include "daemon/geometry/min_norm_point.h"
#include "daemon/motion/spline/quaternion_spline.h"
#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

constexpr double kOneDegree_rad = std::numbers::pi / 180.0;

/// Returns random orientations within about `spread` of one, or all over S³ for a large spread.
std::vector<Vec4> random_orientations(Random& random, int count, double spread) {
  const Vec4 centre = geometry::wxyz(random.rotation());
  std::vector<Vec4> orientations;
  for (int i = 0; i < count; ++i)
    orientations.push_back((centre + spread * geometry::wxyz(random.rotation())).normalized());
  return aligned_orientations(orientations);
}

std::vector<Vec4> turns_about(const Vec3& axis, double turns, double step_deg) {
  std::vector<Vec4> orientations;
  for (double angle_deg = 0.0; angle_deg <= 360.0 * turns; angle_deg += step_deg)
    orientations.push_back(geometry::wxyz(test::turned(axis, angle_deg * kOneDegree_rad)));
  return aligned_orientations(orientations);
}

// The optimality condition is complete: x is nearest to the origin exactly if no point of the hull,
// that is none of the points, lies before the plane through x orthogonal to it. (That x is in the
// hull is the other half: the value below bounds x from both sides.)
TEST(MinNormPoint, IsOptimal) {
  Random random(81);
  for (int i = 0; i < 2000; ++i) {
    const std::vector<Vec4> points =
        random_orientations(random, random.integer(1, 60), random.log_uniform(1e-7, 1.5));
    const Vec4 x = geometry::min_norm_point(points);
    double least = 2.0;
    for (const Vec4& p : points) least = std::min(least, x.dot(p));
    EXPECT_LE(x.squaredNorm() - least, 2.0 * geometry::kMinNormGap) << "set " << i;
  }
}

// Frank & Wolfe's (1956) slow and simple method is the oracle: its iterates are in the hull and
// converge from above, so the true minimum cannot be longer.
TEST(MinNormPoint, IsNoLongerThanAnyPointOfTheHull) {
  Random random(82);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Vec4> points = random_orientations(random, random.integer(2, 30), 1.2);
    Vec4 slow = points[0];
    for (int k = 1; k < 2000; ++k) {
      const Vec4 lowest = *std::ranges::min_element(points, std::ranges::less{},
                                                    [&](const Vec4& p) { return slow.dot(p); });
      slow += 2.0 / (k + 2.0) * (lowest - slow);
    }
    const double length = geometry::min_norm_point(points).norm();
    EXPECT_LE(length, slow.norm() + 4.0 * kEpsilon);
    EXPECT_GE(length, slow.norm() - 0.05) << "and not outside the hull";
  }
}

TEST(MinNormPoint, OfTwoIsTheirMiddle) {
  Random random(83);
  const Vec4 a = geometry::wxyz(random.rotation());
  const Vec4 b = geometry::wxyz(random.rotation());
  EXPECT_LT((geometry::min_norm_point(std::vector<Vec4>{a, b}) - 0.5 * (a + b)).norm(),
            4.0 * kEpsilon);
  EXPECT_EQ(geometry::min_norm_point(std::vector<Vec4>{a, a, a}), a);
}

TEST(LeastDot, IsThatOfDenseSamplesOfTheArcs) {
  Random random(84);
  for (int i = 0; i < 300; ++i) {
    const std::vector<Vec4> q = random_orientations(random, 4, 3.0);
    const Vec4 r = geometry::wxyz(random.rotation());
    double sampled = 2.0;
    constexpr int kSamples = 2000;
    for (std::size_t k = 0; k + 1 < q.size(); ++k) {
      for (int j = 0; j <= kSamples; ++j) {
        const double u = static_cast<double>(j) / kSamples;
        sampled = std::min(sampled, r.dot(((1.0 - u) * q[k] + u * q[k + 1]).normalized()));
      }
    }
    const double least = least_dot_with_polygon(r, q);
    EXPECT_LE(least, sampled + 4.0 * kEpsilon);
    // Between samples at most 2/2000 rad apart the dot product, whose second derivative is at most
    // 1, falls by at most (1/2000)²/2 more.
    EXPECT_GE(least, sampled - 0.5 / kSamples / kSamples);
  }
}

TEST(ReferenceFrame, IsTheBestOfAllInAHemisphere) {
  Random random(85);
  for (int i = 0; i < 200; ++i) {
    const std::vector<Vec4> q = random_orientations(random, random.integer(1, 20), 0.65);
    const Vec4 r = reference_frame(q);
    EXPECT_NEAR(r.norm(), 1.0, 4.0 * kEpsilon);
    const double least = least_dot_with_polygon(r, q);
    ASSERT_GT(least, 0.0);
    for (int k = 0; k < 200; ++k) {
      const Vec4 other =
          (r + random.log_uniform(1e-4, 1.0) * geometry::wxyz(random.rotation())).normalized();
      EXPECT_LE(least_dot_with_polygon(other, q), least + 8.0 * kEpsilon);
    }
  }
}

TEST(ReferenceFrame, IsNearTheBestOfARandomSearch) {
  Random random(86);
  int better = 0;
  int sets = 0;
  for (const int count : {6, 10, 20, 40, 100, 400}) {
    for (int repeat = 0; repeat < 4; ++repeat) {
      const std::vector<Vec4> q = random_orientations(random, count, 1e3);
      double best = -1.0;
      for (int k = 0; k < 20'000; ++k)
        best = std::max(best, least_dot_with_polygon(geometry::wxyz(random.rotation()), q));
      const double clearance_rad = std::acos(-least_dot_with_polygon(reference_frame(q), q));
      const double best_rad = std::acos(-best);
      EXPECT_GE(clearance_rad, best_rad - 1.5 * kOneDegree_rad) << count << " orientations";
      better += clearance_rad >= best_rad ? 1 : 0;
      ++sets;
    }
  }
  EXPECT_GE(2 * better, sets) << "more often than not it is better";
}

// Any number of turns about one axis leaves the directions orthogonal to that circle 90° away.
TEST(ReferenceFrame, KeepsARightAngleFromTenTurns) {
  Random random(87);
  for (const double step_deg : {7.0, 20.0, 45.0, 90.0, 120.0}) {
    for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, 0, 1), random.normal_vector(1.0)}) {
      const std::vector<Vec4> q = turns_about(axis, 10.0, step_deg);
      const double clearance_rad = std::acos(-least_dot_with_polygon(reference_frame(q), q));
      // The linear terms that break ties move r by their weight, 1e-3, times the rest of the mean.
      EXPECT_NEAR(clearance_rad, std::numbers::pi / 2.0, 1e-4) << step_deg;
    }
  }
}

TEST(ReferenceFrame, MovesWithTheWorldFrameAndTheSign) {
  Random random(88);
  std::vector<std::vector<Vec4>> sets = {turns_about(Vec3(0, 1, 0), 10.0, 20.0),
                                         turns_about(Vec3(1, 1, 1), 7.3, 45.0),
                                         turns_about(Vec3(0, 0, 1), 1.0, 45.0)};
  for (int i = 0; i < 100; ++i)
    sets.push_back(random_orientations(random, random.integer(2, 40), i % 2 == 0 ? 0.65 : 1e3));
  for (const std::vector<Vec4>& q : sets) {
    const Vec4 r = reference_frame(q);
    const Vec4 g = geometry::wxyz(random.rotation());
    std::vector<Vec4> moved;
    for (const Vec4& p : q) moved.push_back(quaternion::multiply(g, p));
    // The nearest point of a hull is determined to the square root of rounding at worst; these sets
    // are better than that.
    constexpr double kMoved = 1e-11;
    EXPECT_LT((reference_frame(moved) - quaternion::multiply(g, r)).norm(), kMoved);
    std::vector<Vec4> negative;
    for (const Vec4& p : q) negative.push_back(-p);
    EXPECT_LT((reference_frame(negative) + r).norm(), kMoved);
    std::vector<Vec4> reversed(q.rbegin(), q.rend());
    EXPECT_LT((reference_frame(reversed) - r).norm(), kMoved);
  }
}

}  // namespace
}  // namespace camway::motion
