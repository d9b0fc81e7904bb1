// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/bump.h"

#include "tests/motion/random_motion.h"
#include "tests/motion/smooth_joins.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

CubicPath random_path(Random& random, int keyframes) {
  std::vector<Keyframe> tour;
  double time_s = random.uniform(-5.0, 5.0);
  geometry::Quat orientation = random.rotation();
  for (int i = 0; i < keyframes; ++i) {
    tour.push_back({time_s, {random.normal_vector(3.0), orientation}});
    time_s += random.log_uniform(0.2, 3.0);
    orientation = orientation * test::turned(random.normal_vector(1.0), random.uniform(0.1, 1.5));
  }
  return interpolate_cubic(tour);
}

BumpRow random_row(Random& random, const CubicPath& path, double image_size) {
  const double begin_s = random.uniform(path.begin_s(), path.end_s());
  const double end_s = begin_s + random.uniform(0.1, 2.0);
  BumpRow row{{begin_s, end_s, random.integer(1, 9)}, random.integer(-3, 3), {}};
  for (int i = random.integer(1, 6); i > 0; --i) {
    row.bumps.push_back(
        {random.normal_vector(0.5), image_size * geometry::wxyz(random.rotation())});
  }
  return row;
}

// Returns the uniform cubic B-spline by its definition as a sum of truncated powers (Schoenberg
// 1946).
double b_spline(double x) {
  if (x >= 2.0) return 0.0;  // where the sum cancels, but for rounding that grows with x
  constexpr std::array<double, 5> kSigns = {1.0, -4.0, 6.0, -4.0, 1.0};
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double power = std::max(0.0, x + 2.0 - i);
    sum += kSigns[static_cast<std::size_t>(i)] * power * power * power / 6.0;
  }
  return sum;
}

TEST(Bump, HasThePeakOfTheBSpline) { EXPECT_DOUBLE_EQ(b_spline(0.0), kBumpPeak); }

TEST(Bump, AddsTheBSplineOfItsCoefficients) {
  Random random(812);
  for (int round = 0; round < 100; ++round) {
    const CubicPath path = random_path(random, 5);
    const BumpRow row = random_row(random, path, 0.05);
    const CubicPath changed = with_bumps(path, {&row, 1});
    for (int i = 0; i < 50; ++i) {
      const double time_s = random.uniform(path.begin_s(), path.end_s());
      CubicPoint expected = path.at(time_s);
      for (std::size_t k = 0; k < row.bumps.size(); ++k) {
        const double peak_s = row.knots.knot_s(row.first + static_cast<int>(k));
        const double weight = b_spline((time_s - peak_s) / row.knots.spacing_s());
        expected.position += weight * row.bumps[k].position;
        expected.image += weight * row.bumps[k].image;
      }
      const CubicPoint point = changed.at(time_s);
      EXPECT_LT((point.position - expected.position).norm(), 1e-12);
      EXPECT_LT((point.image - expected.image).norm(), 1e-12);
    }
  }
}

TEST(Bump, KeepsThePathSmooth) {
  Random random(813);
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(::testing::Message() << "round " << round);
    const CubicPath path = random_path(random, 6);
    const std::vector<BumpRow> rows = {random_row(random, path, 0.05),
                                       random_row(random, path, 0.05)};
    // The rounding of three convex combinations that cut the interpolating cubic, and of two rows
    // of up to four terms.
    test::expect_smooth(with_bumps(path, rows).path(), 16.0);
  }
}

// Knots are a few nanoseconds apart, or as far from time 0 as seconds since 1970. The rows have
// their knots where the path has knots, and the path stays smooth by the numbers that are sent.
TEST(Bump, KeepsThePathSmoothWhereKnotsAreNear) {
  Random random(817);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(::testing::Message() << "round " << round);
    const CubicPath path = random_path(random, 6);
    const auto places = std::make_shared<KnotPlaces>();
    for (const CubicPiece& piece : path.pieces) places->taken_s.push_back(piece.t0_s);
    places->taken_s.push_back(path.end_s());
    places->same_s = 1e-5;
    BumpRow row = random_row(random, path, 0.05);
    // One of its inner knots is next to a knot of the path.
    const double near_s = path.pieces[2].t0_s + random.log_uniform(1e-12, 5e-6);
    const double spacing_s = row.knots.spacing_s();
    row.knots = {near_s - 2.0 * spacing_s, near_s + 2.0 * spacing_s, 4, places};
    row.first = random.integer(0, 4);
    const CubicPath changed = with_bumps(path, {&row, 1});
    test::expect_smooth(changed.path(), 16.0);
    for (const CubicPiece& piece : changed.pieces) EXPECT_GT(piece.t1_s - piece.t0_s, 1e-6);
  }
}

// The piece under the wide row is further away, in spacings of the narrow row, than an int can
// count; a loop over the spacings would not end.
TEST(Bump, OfRowsOfVeryDifferentWidths) {
  Random random(816);
  const CubicPath path = random_path(random, 6);
  const double begin_s = path.begin_s();
  const double middle_s = 0.5 * (begin_s + path.end_s());
  const CubicPoint up{{0.0, 0.1, 0.0}, geometry::Vec4::Zero()};
  const BumpRow wide{{begin_s, path.end_s(), 4}, 2, {up}};
  const BumpRow narrow{{middle_s, middle_s + 4e-12, 4}, 2, {up}};
  const std::vector<BumpRow> both = {wide, narrow};
  const CubicPath changed = with_bumps(path, both);
  const CubicPath by_wide = with_bumps(path, {&wide, 1});
  const double away_s = begin_s + 0.3 * (path.end_s() - begin_s);
  EXPECT_LT((changed.at(away_s).position - by_wide.at(away_s).position).norm(), 1e-12);
}

TEST(Bump, ChangesNoBitOutsideItsSupport) {
  Random random(814);
  for (int round = 0; round < 100; ++round) {
    const CubicPath path = random_path(random, 6);
    const BumpRow row = random_row(random, path, 0.05);
    const CubicPath changed = with_bumps(path, {&row, 1});
    for (const CubicPiece& piece : path.pieces) {
      if (piece.t1_s > row.begin_s() && piece.t0_s < row.end_s()) continue;
      const bool is_there = std::ranges::any_of(changed.pieces, [&](const CubicPiece& other) {
        return other.t0_s == piece.t0_s && other.t1_s == piece.t1_s &&
               other.position == piece.position && other.image == piece.image;
      });
      EXPECT_TRUE(is_there);
    }
    EXPECT_EQ(changed.begin_s(), path.begin_s());
    EXPECT_EQ(changed.end_s(), path.end_s());
  }
}

TEST(CubicPath, SaysWhatItsSegmentsSay) {
  Random random(815);
  const CubicPath cubic = random_path(random, 8);
  const Path path = cubic.path();
  for (int i = 0; i < 500; ++i) {
    const double time_s = random.uniform(cubic.begin_s(), cubic.end_s());
    const Pose expected = path.pose(time_s);
    const Pose pose = cubic.pose(time_s);
    EXPECT_LT((pose.position - expected.position).norm(), 64 * kEpsilon * 10.0);
    EXPECT_LT(test::rotation_angle_rad(pose.orientation, expected.orientation), 64 * kEpsilon);
  }
}

TEST(CubicPath, AroundAndReplaceAreInverse) {
  Random random(816);
  const CubicPath path = random_path(random, 8);
  const double from_s = path.pieces[2].t0_s;
  const double to_s = path.pieces[4].t1_s;
  const CubicPath part = path.around(from_s, to_s);
  EXPECT_EQ(part.pieces.size(), 3U);
  EXPECT_EQ(part.begin_s(), from_s);
  EXPECT_EQ(part.end_s(), to_s);
  CubicPath whole = path;
  const BumpRow row{
      {from_s, to_s, 8}, 2, std::vector<CubicPoint>(5, {Vec3(1, 2, 3), Vec4::Zero()})};
  whole.replace(with_bumps(part, {&row, 1}));
  EXPECT_EQ(whole.begin_s(), path.begin_s());
  EXPECT_EQ(whole.end_s(), path.end_s());
  test::expect_smooth(whole.path(), 16.0);
  EXPECT_NEAR((whole.at(0.5 * (from_s + to_s)).position - path.at(0.5 * (from_s + to_s)).position -
               Vec3(1, 2, 3))
                  .norm(),
              0.0, 1e-12);
}

}  // namespace
}  // namespace camway::motion
