// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/fidelity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/geometry/types.h"
#include "daemon/motion/path/quaternion.h"
#include "daemon/motion/spline/bump.h"
#include "tests/bench/fidelity/assembly.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/known_paths.h"
#include "tests/bench/fidelity/same_frame.h"
#include "tests/bench/fidelity/test_shots.h"
#include "tests/support/temporary_folder.h"

namespace camway::bench {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using testing::Random;

constexpr double kRounding = 1e-9;  // of samples of a path of ten metres

/// The path moved by `offset_m` and turned by `turn` at every instant.
motion::Path displaced(const motion::Path& path, const Vec3& offset_m, const Quat& turn) {
  std::vector<motion::Segment> segments(path.segments().begin(), path.segments().end());
  for (motion::Segment& segment : segments) {
    for (Vec3& point : segment.position) point += offset_m;
    for (geometry::Vec4& point : segment.orientation) {
      point = motion::quaternion::multiply(point, geometry::wxyz(turn));
    }
  }
  return motion::Path(std::move(segments));
}

/// The path with a random row of bumps between two times. `turn`: size of its image.
CubicPath bumped(const CubicPath& path, double begin_s, double end_s, Random& random,
                 double turn = 0.05) {
  motion::BumpRow row{motion::KnotRow(begin_s, end_s, 6), 2, {}};
  for (int i = 0; i < 3; ++i) {
    geometry::Vec4 image;
    image << random.uniform(-turn, turn), random.in_cube(turn);
    row.bumps.push_back({random.in_cube(0.3), image});
  }
  return motion::with_bumps(path, std::span(&row, 1));
}

double distance(const CubicPath& a, const CubicPath& b, double time_s) {
  const motion::CubicPoint one = a.at(time_s);
  const motion::CubicPoint other = b.at(time_s);
  return (one.position - other.position).norm() + (one.image - other.image).norm();
}

TEST(Fidelity, MeasuresAConstantDisplacementExactly) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const motion::Path original = motion::interpolate(curved_flight(random));
    const Vec3 offset_m = random.in_cube(1.0);
    const double turn_rad = random.uniform(0.01, 3.0);
    const Quat turn(Eigen::AngleAxisd(turn_rad, random.direction()));
    const Fidelity seen = fidelity_of(displaced(original, offset_m, turn), original, 3.0);
    EXPECT_NEAR(seen.moved_m, offset_m.norm(), kRounding);
    EXPECT_NEAR(seen.turned_rad, turn_rad, kRounding);
    EXPECT_NEAR(seen.shift_rad, turn_rad + std::atan(offset_m.norm() / 3.0), kRounding);
    EXPECT_EQ(seen.changed, 1.0);
    EXPECT_NEAR(seen.acceleration, 1.0, kRounding);
    EXPECT_NEAR(seen.length, 1.0, kRounding);
  }
}

TEST(Fidelity, ChangesNothingWhereNothingChanges) {
  Random random(2);
  const motion::Path path = motion::interpolate(curved_flight(random));
  const Fidelity same = fidelity_of(path, path, 3.0);
  EXPECT_EQ(same.shift_rad, 0.0);
  EXPECT_EQ(same.changed, 0.0);
}

TEST(Fidelity, IsTheShareOfTimeThatABumpChanges) {
  Random random(3);
  const CubicPath original = motion::interpolate_cubic(curved_flight(random));
  const CubicPath path = bumped(original, 4.0, 6.0, random);
  // A bump is below the least change that counts near its ends.
  const double changed = fidelity_of(path.path(), original.path(), 3.0).changed;
  EXPECT_LE(changed, 0.2);
  EXPECT_GE(changed, 0.15);
}

TEST(ChangedRanges, AreTheSupportsOfBumps) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const CubicPath original = motion::interpolate_cubic(curved_flight(random));
    const double begin_s = random.uniform(0.5, 3.0);
    const double end_s = random.uniform(3.5, 5.0);
    const CubicPath once = bumped(original, begin_s, end_s, random);
    const auto ranges = changed_ranges(bumped(once, 6.0, 9.0, random), original);
    ASSERT_EQ(ranges.size(), 2U);
    EXPECT_EQ(ranges[0].begin_s, begin_s);
    EXPECT_EQ(ranges[0].end_s, end_s);
    EXPECT_EQ(ranges[1].begin_s, 6.0);
    EXPECT_EQ(ranges[1].end_s, 9.0);
  }
}

TEST(Assembly, IsEachPartInItsRange) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const std::vector<motion::Keyframe> given = curved_flight(random);
    const CubicPath original = motion::interpolate_cubic(given);
    const CubicPath early = bumped(original, 0.4, 1.7, random);
    const CubicPath late = bumped(bumped(original, 0.3, 1.5, random), 4.1, 5.9, random);
    const std::vector<PathPart> parts = {{{0.2, 1.8}, &early}, {{4.0, 6.0}, &late}};
    const CubicPath whole = assembled(original, given, parts);
    for (int k = 0; k <= 100; ++k) {
      const double time_s = 0.1 * k;
      const CubicPath& expected = time_s < 2.0 ? early : time_s < 4.0 ? original : late;
      EXPECT_LE(distance(whole, expected, time_s), kRounding);
    }
  }
}

TEST(SameFrame, CostsAsMuchAsThePathItself) {
  Random random(6);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  for (int i = 0; i < 10; ++i) {
    const BenchRequest request = request_of(curved_flight(random));
    const Shot shot(*scene, request, 1.0);
    const CubicPath moved = bumped(shot.interpolated(), 4.0, 6.0, random, 0.0);
    const auto cost_in_frame = [&](const motion::Path& path) {
      return shot.cost(in_frame_of(shot.interpolated(), path));
    };
    // Images are interpolated at 32 times of each piece.
    const double cost = shot.cost(moved);
    EXPECT_LE(cost_in_frame(shot.original()), 1e-4 * cost);
    EXPECT_NEAR(cost_in_frame(moved.path()), cost, 1e-3 * cost);
    // The lengths of images represent nothing. Those of the original cost no more than random ones.
    const CubicPath turned = bumped(shot.interpolated(), 4.0, 6.0, random);
    EXPECT_LE(cost_in_frame(turned.path()), 1.02 * shot.cost(turned));
  }
}

TEST(KnownPaths, AreTheSamePathsAfterAFile) {
  Random random(7);
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "known.json").string();
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  const CubicPath path = bumped(shot.interpolated(), 4.1, 5.9, random);
  KnownPaths known(file);
  EXPECT_TRUE(known.of("test", shot).empty());
  known.keep("test", shot, "best_known", path);
  ASSERT_EQ(known.write(), "");
  const std::vector<CubicPath> again = KnownPaths(file).of("test", shot);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(shot.cost(again.front()), shot.cost(path));
  // Other keyframes have no use for it.
  const BenchRequest other = request_of(curved_flight(random));
  EXPECT_TRUE(KnownPaths(file).of("test", Shot(*scene, other, 1.0)).empty());
}

}  // namespace
}  // namespace camway::bench
