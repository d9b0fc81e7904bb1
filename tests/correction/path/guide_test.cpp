// SPDX-License-Identifier: MIT
#include "daemon/correction/path/guide.h"

#include <gtest/gtest.h>

#include "daemon/motion/spline/interpolate.h"
#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using motion::CubicPath;
using motion::CubicPoint;
using motion::KnotRow;

constexpr double kSumRounding_m = 1e-12;  // of sums of a few metres

/// Returns a path through three keyframes; guides replace the part between the first two.
CubicPath path_at(const Vec3& middle, const Quat& turned) {
  return motion::interpolate_cubic(
      std::vector<motion::Keyframe>{{0.0, {Vec3(0, 0, 2), Quat::Identity()}},
                                    {3.0, {middle, turned}},
                                    {5.0, {Vec3(0.5, 0, -4), turned}}});
}

CubicPath some_path() {
  return path_at({0.3, 0.1, -1.5}, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())));
}

/// Returns a guide from the path's first keyframe to the second, over some poses far off the path.
Guide some_guide(testing::Random& random, const CubicPath& path, int poses, double off_m) {
  std::uniform_real_distribution<double> place(-off_m, off_m);
  const SignedPose from = signed_pose_at(path, 0.0);
  const SignedPose to = signed_pose_at(path, 3.0);
  Guide guide = {from};
  for (int i = 1; i <= poses; ++i) {
    SignedPose pose = motion::between(from, to, i / (poses + 1.0));
    const double x = place(random);
    const double y = place(random);
    pose.position += Vec3(x, y, 0.0);
    pose.orientation = (pose.orientation + 0.3 * place(random) * Vec4(0, 1, 0, 1)).normalized();
    guide.push_back(pose);
  }
  guide.push_back(to);
  return guide;
}

void expect_same_pose(const SignedPose& a, const SignedPose& b) {
  EXPECT_LT((a.position - b.position).norm(), kSumRounding_m);
  EXPECT_LT((a.orientation - b.orientation).norm(), kSumRounding_m);
}

TEST(SignedPoseAt, IsThePathsOwnAndContinuous) {
  const CubicPath path = some_path();
  SignedPose last = signed_pose_at(path, 0.0);
  for (double time_s = 0.0; time_s <= 5.0; time_s += 0.01) {
    const SignedPose now = signed_pose_at(path, time_s);
    const motion::Pose pose = path.pose(time_s);
    EXPECT_LT((now.position - pose.position).norm(), kSumRounding_m);
    EXPECT_LT(pose.orientation.angularDistance(geometry::from_wxyz(now.orientation)), 1e-7);
    EXPECT_GT(now.orientation.dot(last.orientation), 0.99);
    last = now;
  }
}

TEST(PoseAtShare, IsBetweenItsNeighbours) {
  const Vec3 axis = Vec3(1, -2, 2).normalized();
  const auto turned = [&](double angle_rad) { return Quat(Eigen::AngleAxisd(angle_rad, axis)); };
  const std::vector<motion::Pose> poses = {
      {Vec3(0, 0, 0), turned(0.0)}, {Vec3(2, 0, 0), turned(0.4)}, {Vec3(2, 4, 0), turned(1.0)}};
  const std::vector<std::pair<double, motion::Pose>> wanted = {
      {0.0, poses[0]}, {0.25, {Vec3(1, 0, 0), turned(0.2)}},
      {0.5, poses[1]}, {0.875, {Vec3(2, 3, 0), turned(0.85)}},
      {1.0, poses[2]},
  };
  for (const auto& [share, pose] : wanted) {
    const motion::Pose found = pose_at_share(poses, share);
    EXPECT_LT((found.position - pose.position).norm(), kSumRounding_m) << share;
    EXPECT_LT((found.orientation.coeffs() - pose.orientation.coeffs()).norm(), kSumRounding_m)
        << share;
  }
}

TEST(TimedGuide, BeginsAndEndsWithTheGuide) {
  testing::Random random(1);
  const SearchScene scene({});
  for (int run = 0; run < 20; ++run) {
    const CubicPath path = some_path();
    const Guide guide = some_guide(random, path, run % 5, 2.0);
    const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
    expect_same_pose(timed.at(0.0), guide.front());
    expect_same_pose(timed.at(3.0), guide.back());
  }
}

// The position along the guide never decreases, and moves at most twice as fast as the mean. The
// test reads it from the pose: a guide that is longer than the straight line everywhere has
// different poses everywhere.
TEST(TimedGuide, GoesForwardAndDoesNotHurry) {
  const SearchScene scene({});
  const CubicPath path = path_at({0, 0, -2}, Quat::Identity());
  const SignedPose from = signed_pose_at(path, 0.0);
  const SignedPose to = signed_pose_at(path, 3.0);
  // The guide goes sideways, forwards and back, so that the place determines the distance along it.
  const Guide guide = {from, {{3, 0, 2}, from.orientation}, {{3, 0, -2}, from.orientation}, to};
  const auto gone_m = [&](const SignedPose& pose) {
    if (pose.position.z() > 2.0 - 1e-9) return pose.position.x();
    if (pose.position.z() > -2.0 + 1e-9) return 5.0 - pose.position.z();
    return 10.0 - pose.position.x();
  };
  const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
  constexpr int kSteps = 1000;
  double last_m = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double now_m = gone_m(timed.at(3.0 * i / kSteps));
    EXPECT_GE(now_m, last_m - kSumRounding_m);
    EXPECT_LE(now_m - last_m, 2.0 * 10.0 / kSteps + 1e-9);
    last_m = now_m;
  }
  EXPECT_NEAR(last_m, 10.0, 1e-9);
}

// A guide along the path itself keeps the path's times, up to the resolution of a grid of 24 times
// and 96 places.
TEST(TimedGuide, KeepsTheTimesOfThePath) {
  const SearchScene scene({});
  const CubicPath path = path_at({0, 0, -2}, Quat::Identity());
  const Guide guide = {signed_pose_at(path, 0.0), signed_pose_at(path, 3.0)};
  const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
  for (double time_s = 0.0; time_s <= 3.0; time_s += 0.05) {
    EXPECT_LT((timed.at(time_s).position - path.at(time_s).position).norm(), 0.35);
  }
}

TEST(TimedGuide, OfPosesThatAreAllTheSame) {
  const SearchScene scene({});
  const CubicPath path = some_path();
  const Guide guide(3, signed_pose_at(path, 0.0));
  const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
  for (double time_s = 0.0; time_s <= 3.0; time_s += 0.1)
    expect_same_pose(timed.at(time_s), guide[0]);
}

TEST(OffsetsTo, LeadToTheGuideAtEveryKnot) {
  testing::Random random(2);
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  for (int run = 0; run < 20; ++run) {
    const CubicPath path = some_path();
    const Guide guide = some_guide(random, path, 4, 1.0);
    const KnotRow knots{0.0, 3.0, 8 + run};
    const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
    const std::optional<Offsets> offsets =
        offsets_to(path, path, timed, knots, Turning::kAsGuide, space);
    ASSERT_TRUE(offsets);
    EXPECT_EQ(offsets->first, 1);
    EXPECT_EQ(offsets->last(), knots.count - 1);
    for (int k = 1; k < knots.count; ++k) {
      const CubicPoint old = path.at(knots.knot_s(k));
      const CubicPoint sum{old.position + (*offsets)(k).position, old.image + (*offsets)(k).image};
      const motion::Pose pose = motion::pose_of(path.reference, sum);
      const motion::Pose wanted = motion::unsigned_pose(timed.at(knots.knot_s(k)));
      EXPECT_LT((pose.position - wanted.position).norm(), kSumRounding_m);
      EXPECT_LT(pose.orientation.angularDistance(wanted.orientation), 1e-7);
      EXPECT_NEAR(sum.image.norm(), old.image.norm(), kSumRounding_m);
    }
    const std::optional<Offsets> moved =
        offsets_to(path, path, timed, knots, Turning::kAsPath, space);
    ASSERT_TRUE(moved);
    for (int k = 1; k < knots.count; ++k) {
      EXPECT_TRUE((*moved)(k).image.isZero(0.0));
      // The centre of the body is on the guide.
      const motion::Pose old = path.pose(knots.knot_s(k));
      const motion::Pose now{old.position + (*moved)(k).position, old.orientation};
      const motion::Pose wanted = motion::unsigned_pose(timed.at(knots.knot_s(k)));
      EXPECT_LT((space.center_W(now) - space.center_W(wanted)).norm(), kSumRounding_m);
    }
  }
}

// The image rotates a quarter as fast as the camera: after two full turns it arrives with the other
// sign, and there is no spline to the old keyframe with that rotation.
TEST(OffsetsTo, NothingForAGuideThatArrivesWithTheOtherSign) {
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  const CubicPath path = path_at({0, 0, -2}, Quat::Identity());
  for (const int turns : {0, 2, 4}) {
    Guide guide;
    const int steps = 1 + 8 * turns;
    for (int i = 0; i <= steps; ++i) {
      const double half_rad = std::numbers::pi * turns * i / steps;
      guide.push_back(
          {Vec3(0, 0, 2.0 - 4.0 * i / steps), Vec4(std::cos(half_rad), std::sin(half_rad), 0, 0)});
    }
    const TimedGuide timed(path, guide, 0.0, 3.0, scene.space());
    const KnotRow knots{0.0, 3.0, 64};
    EXPECT_EQ(offsets_to(path, path, timed, knots, Turning::kAsGuide, space).has_value(),
              turns != 2)
        << turns;
    EXPECT_TRUE(offsets_to(path, path, timed, knots, Turning::kAsPath, space));
  }
}

struct BumpsCase {
  CubicPath path = some_path();
  Offsets offsets;
};

BumpsCase bumps_case(testing::Random& random, int count) {
  BumpsCase result;
  const SearchScene scene({});
  const Guide guide = some_guide(random, result.path, 4, 1.0);
  const TimedGuide timed(result.path, guide, 0.0, 3.0, scene.space());
  result.offsets = *offsets_to(result.path, result.path, timed, {0.0, 3.0, count},
                               Turning::kAsGuide, scene.space());
  return result;
}

TEST(BumpsFor, KeepKeyframesAndWhatIsBeyond) {
  testing::Random random(3);
  for (const int count : {4, 5, 8, 16, 33}) {
    const BumpsCase c = bumps_case(random, count);
    for (const Ends ends : {Ends::kFree, Ends::kFixed}) {
      const motion::BumpRow row = bumps_for(c.offsets, ends);
      const CubicPath now = motion::with_bumps(c.path, std::array{row});
      for (const double time_s : {0.0, 3.0}) {
        const CubicPoint before = c.path.at(time_s);
        EXPECT_LT((now.at(time_s).position - before.position).norm(), 1e-13);
        EXPECT_LT((now.at(time_s).image - before.image).norm(), 1e-13);
      }
      const double spacing_s = 3.0 / count;
      const double reach_s = ends == Ends::kFree ? 2.0 * spacing_s : 0.0;
      EXPECT_GE(row.begin_s(), -reach_s - 1e-12);
      EXPECT_LE(row.end_s(), 3.0 + reach_s + 1e-12);
      for (double time_s = 3.0 + reach_s; time_s <= 5.0; time_s += 0.01)
        EXPECT_LT((now.at(time_s).position - c.path.at(time_s).position).norm(), 1e-13);
    }
  }
}

// Variation diminishing: between two knots the addition is in the hull of the four coefficients
// about them, which include the outer ones that keep the keyframes.
TEST(BumpsFor, SwingNoFurtherThanTheCoefficients) {
  testing::Random random(4);
  for (const int count : {6, 8, 16, 33}) {
    const BumpsCase c = bumps_case(random, count);
    const motion::BumpRow row = bumps_for(c.offsets, Ends::kFree);
    const CubicPath now = motion::with_bumps(c.path, std::array{row});
    const auto coefficient = [&](int k) -> Vec3 {
      if (k == 0) return -0.25 * c.offsets(1).position;
      if (k == count) return -0.25 * c.offsets(count - 1).position;
      return k < 0 || k > count ? Vec3::Zero() : c.offsets(k).position;
    };
    for (int k = 0; k < count; ++k) {
      geometry::Box hull;
      for (int i = k - 1; i <= k + 2; ++i) hull.extend(coefficient(i));
      for (int part = 0; part <= 10; ++part) {
        const double time_s = 3.0 / count * (k + 0.1 * part);
        const Vec3 added = now.at(time_s).position - c.path.at(time_s).position;
        EXPECT_LT(hull.exteriorDistance(added), 1e-12) << k << " of " << count;
      }
    }
  }
}

// Schoenberg's operator keeps straight lines.
TEST(BumpsFor, ReproducesWhatIsLinear) {
  constexpr int kCount = 16;
  const CubicPath path = some_path();
  Offsets offsets{{0.0, 3.0, kCount}, 1, {}};
  const Vec3 slope(0.1, -0.2, 0.05);
  for (int k = 1; k < kCount; ++k)
    offsets.at.push_back({Vec3(1, 2, 3) + k * slope, Vec4(0.1, 0, 0, 0.01 * k)});
  for (const Ends ends : {Ends::kFree, Ends::kFixed}) {
    const CubicPath now = motion::with_bumps(path, std::array{bumps_for(offsets, ends)});
    for (double knot = 3.0; knot <= kCount - 3.0; knot += 0.125) {
      const double time_s = 3.0 * knot / kCount;
      const CubicPoint before = path.at(time_s);
      EXPECT_LT((now.at(time_s).position - before.position - Vec3(1, 2, 3) - knot * slope).norm(),
                kSumRounding_m);
      EXPECT_LT((now.at(time_s).image - before.image - Vec4(0.1, 0, 0, 0.01 * knot)).norm(),
                kSumRounding_m);
    }
  }
}

TEST(BumpsFor, NoneForWhatStays) {
  const Offsets none{{0.0, 3.0, 8}, 1, std::vector<CubicPoint>(7)};
  EXPECT_TRUE(bumps_for(none, Ends::kFree).bumps.empty());
  EXPECT_TRUE(bumps_for(none, Ends::kFixed).bumps.empty());
  Offsets one = none;
  one.at[3].position = Vec3::UnitX();
  const motion::BumpRow row = bumps_for(one, Ends::kFixed);
  EXPECT_EQ(row.first, 4);
  EXPECT_EQ(row.bumps.size(), 1U);
}

double length_m(const Guide& guide, const FreeSpace& space) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < guide.size(); ++i) sum_m += space.distance_m(guide[i - 1], guide[i]);
  return sum_m;
}

TEST(Divided, HasTheFewestPartsThatAreShortEnough) {
  constexpr double kLongest_m = 0.3;
  testing::Random random(7);
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  for (int run = 0; run < 20; ++run) {
    const Guide guide = some_guide(random, some_path(), 5, 1.0);
    Guide expected = {guide.front()};
    for (std::size_t i = 1; i < guide.size(); ++i) {
      int parts = 1;
      while (space.distance_m(guide[i - 1], guide[i]) > parts * kLongest_m) ++parts;
      for (int k = 1; k < parts; ++k) {
        expected.push_back(motion::between(guide[i - 1], guide[i], static_cast<double>(k) / parts));
      }
      expected.push_back(guide[i]);
    }
    EXPECT_GT(expected.size(), guide.size());
    EXPECT_TRUE(same(divided(guide, space, kLongest_m), expected));
  }
}

// The motion is as long as coordinates permit, with more of these steps than an int can count.
TEST(Divided, HasNoMorePartsThanItMayHoweverLongTheMotion) {
  constexpr double kLongest_m = 0.1;
  const SearchScene scene({});
  const Vec4 still(1, 0, 0, 0);
  const Guide result =
      divided({{Vec3(-1e9, 0, 0), still}, {Vec3(1e9, 0, 0), still}}, scene.space(), kLongest_m);
  ASSERT_EQ(result.size(), kMostPartsOfMotion + 1U);
  EXPECT_EQ(result[kMostPartsOfMotion / 2].position, Vec3::Zero());
}

TEST(Shortened, IsStraightInTheOpen) {
  testing::Random random(5);
  const SearchScene scene({});
  FreeSpace space = scene.space();
  const Guide guide = some_guide(random, some_path(), 20, 1.0);
  EXPECT_TRUE(same(shortened(guide, space, 0.0), {guide.front(), guide.back()}));
}

TEST(Shortened, IsNoLongerAndStillFree) {
  constexpr double kMargin_m = 0.01;
  testing::Random random(6);
  int shorter = 0;
  int bent = 0;
  for (int run = 0; run < 200; ++run) {
    const SearchScene scene(scattered_cuboids(random, 6, 0.6));
    FreeSpace space = scene.space();
    const Guide guide = some_guide(random, some_path(), 12, 0.5);
    if (!is_proved_free(scene, guide, kMargin_m)) continue;
    const Guide result = shortened(guide, space, kMargin_m);
    EXPECT_TRUE(same({result.front(), result.back()}, {guide.front(), guide.back()}));
    EXPECT_LE(length_m(result, space), length_m(guide, space) + 1e-12);
    EXPECT_TRUE(is_proved_free(scene, result, 0.5 * kMargin_m));
    EXPECT_GE(least_distance_m(scene, space, result, 5e-3), kMargin_m - 1e-9);
    shorter += result.size() < guide.size() ? 1 : 0;
    bent += result.size() > 2 ? 1 : 0;
  }
  EXPECT_GE(shorter, 10);
  EXPECT_GE(bent, 5);
}

// Motions between poses that are further apart than the shorter rotation are not changed.
TEST(Shortened, DoesNotTurnTheOtherWay) {
  const SearchScene scene({});
  FreeSpace space = scene.space();
  Guide guide;
  for (int i = 0; i <= 16; ++i) {
    const double half_rad = std::numbers::pi * i / 16;
    guide.push_back({Vec3(0, 0, -i), Vec4(std::cos(half_rad), 0, std::sin(half_rad), 0)});
  }
  const Guide result = shortened(guide, space, 0.0);
  EXPECT_LT(result.size(), guide.size());
  for (std::size_t i = 1; i < result.size(); ++i)
    EXPECT_GT(result[i - 1].orientation.dot(result[i].orientation), 0.0);
}

}  // namespace
}  // namespace camway::correction
