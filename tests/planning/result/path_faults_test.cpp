// SPDX-License-Identifier: MIT
#include "daemon/planning/result/path_faults.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/stages/path_check.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::Keyframe;
using motion::Path;
using motion::Segment;
using ::testing::HasSubstr;

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Keyframe>& keyframes() {
  static const std::vector<Keyframe> kKeyframes{
      {0.0, {{0, 0, 2}, Quat::Identity()}},
      {1.0, {{0.2, 0, 0}, Quat(Eigen::AngleAxisd(0.7, Vec3::UnitY()))}},
      {3.0, {{0, 0, -2}, Quat::Identity()}}};
  return kKeyframes;
}

std::vector<Segment> tour_segments() {
  const Path path = motion::interpolate(keyframes());
  return {path.segments().begin(), path.segments().end()};
}

motion::Corners corners_C() { return motion::near_corners_C(testing::small_camera()); }
double radius_m() { return motion::body_radius_m(corners_C()); }

/// Returns a segment of a camera that looks along -Z and moves from z0 to z1.
Segment straight(double t0_s, double t1_s, double z0_m, double z1_m) {
  Segment segment;
  segment.t0_s = t0_s;
  segment.t1_s = t1_s;
  for (std::size_t i = 0; i < 4; ++i) {
    segment.position[i] = {0, 0, z0_m + (z1_m - z0_m) * static_cast<double>(i) / 3.0};
  }
  segment.orientation.fill(Vec4(1, 0, 0, 0));
  return segment;
}

TEST(FindFault, AcceptsOurPaths) { EXPECT_EQ(find_fault(tour_segments()), std::nullopt); }

TEST(FindFault, NamesSegmentAndField) {
  const std::vector<std::pair<std::string, std::function<void(Segment&)>>> faults{
      {"segments[1].t1: ", [](Segment& s) { s.t1_s = s.t0_s; }},
      {"segments[1].t1: ", [](Segment& s) { s.t1_s = s.t0_s - 1.0; }},
      {"segments[1].t0: ", [](Segment& s) { s.t0_s -= 0.5; }},
      {"segments[1].t0: ", [](Segment& s) { s.t0_s += 0.5; }},
      {"segments[1].t0: ", [](Segment& s) { s.t0_s = kNan; }},
      {"segments[1].t1: ", [](Segment& s) { s.t1_s = kEndless; }},
      {"segments[1].t1: ", [](Segment& s) { s.t1_s = 1e11; }},
      {"segments[1].position[2]: ", [](Segment& s) { s.position[2].y() = kNan; }},
      {"segments[1].position[0]: ", [](Segment& s) { s.position[0].x() = -kEndless; }},
      {"segments[1].position[3]: ", [](Segment& s) { s.position[3].z() = -1e200; }},
      {"segments[1].position[1]: ", [](Segment& s) { s.position[1].z() = 1.001e9; }},
      {"segments[1].orientation[3]: ", [](Segment& s) { s.orientation[3][1] = kNan; }},
      {"segments[1].orientation[5]: ", [](Segment& s) { s.orientation[5][2] = kEndless; }},
      {"segments[1].orientation[0]: ", [](Segment& s) { s.orientation.fill(Vec4::Zero()); }},
      {"segments[1].orientation[0]: ",
       [](Segment& s) { s.orientation.fill(Vec4(1e-200, 0, 0, 0)); }},
      {"segments[1].orientation[0]: ",
       [](Segment& s) { s.orientation.fill(Vec4(0, 1e200, 0, 0)); }},
      {"segments[1].orientation[6]: ", [](Segment& s) { s.orientation[6] = Vec4::Zero(); }},
      {"segments[1].orientation[6]: ", [](Segment& s) { s.orientation[6] *= 1e-20; }},
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    std::vector<Segment> segments{straight(0, 1, 2, 1), straight(1, 2, 1, 0), straight(2, 3, 0, 1)};
    faults[i].second(segments[1]);
    const std::optional<std::string> fault = find_fault(segments);
    ASSERT_TRUE(fault) << "fault " << i;
    EXPECT_THAT(*fault, ::testing::StartsWith(faults[i].first)) << "fault " << i;
  }
  EXPECT_TRUE(find_fault({}));
}

TEST(FindFault, AcceptsWhatIsOnlyUnusual) {
  // Length and sign of four-vectors have no meaning, and one inside may even be zero.
  for (const double factor : {1e-99, -1.0, 1e99}) {
    Segment segment = straight(0, 1e-9, 1e9, -1e9);
    for (Vec4& q : segment.orientation) q *= factor;
    segment.orientation[3].setZero();
    EXPECT_EQ(find_fault({&segment, 1}), std::nullopt) << factor;
  }
}

// A path without faults can be evaluated, which is the reason for the limits.
TEST(FindFault, LetsPassOnlyWhatGivesFinitePosesAtTheEnds) {
  testing::Random random(7);
  std::uniform_real_distribution<double> exponent(-160.0, 160.0);
  std::uniform_real_distribution<double> coefficient(-1.0, 1.0);
  int passed = 0;
  for (int round = 0; round < 2000; ++round) {
    Segment segment = straight(0, 1, 2, 1);
    const double size = std::pow(10.0, exponent(random));
    for (Vec4& q : segment.orientation) {
      for (double& c : q) c = size * coefficient(random);
    }
    if (find_fault({&segment, 1})) continue;
    ++passed;
    for (const double u : {0.0, 1.0}) {
      const Vec4 q = geometry::wxyz(motion::pose_at(segment, u).orientation);
      EXPECT_NEAR(q.norm(), 1.0, 1e-15) << size;
    }
  }
  EXPECT_GT(passed, 1000);  // of 200/320 of them
}

TEST(PoseDistance, BoundsTheWayOfEveryCornerAndIsTightForATurn) {
  testing::Random random(8);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::uniform_real_distribution<double> angle_rad(0.0, 3.0);
  for (int round = 0; round < 1000; ++round) {
    const Quat turn(Eigen::AngleAxisd(
        angle_rad(random),
        testing::looking_along(Vec3(place(random), place(random), place(random))) * Vec3::UnitX()));
    const motion::Pose a{{place(random), place(random), 0}, random.rotation()};
    const motion::Pose b{{place(random), place(random), 0}, a.orientation * turn};
    const motion::Corners at_a = motion::corners_W(corners_C(), a);
    const motion::Corners at_b = motion::corners_W(corners_C(), b);
    const double bound_m = pose_distance_m(a, b, radius_m());
    for (std::size_t k = 0; k < 4; ++k) {
      // The bound takes a dozen roundings of numbers below 4.
      EXPECT_LE((at_a[k] - at_b[k]).norm(), bound_m + 1e-14);
    }
  }
  const motion::Pose still{Vec3::Zero(), Quat::Identity()};
  const motion::Pose turned{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.01, Vec3::UnitY()))};
  EXPECT_NEAR(pose_distance_m(still, turned, 1.0), 0.01, 1e-6);  // sin(x) = x - x³/6
}

TEST(FindJump, AcceptsOurPathsAndNamesTheSegmentOfALeap) {
  std::vector<Segment> segments = tour_segments();
  ASSERT_GE(segments.size(), 2u);
  EXPECT_FALSE(find_jump(Path(segments), radius_m()));
  segments[1].position[0].x() += 1e-6;
  const std::optional<std::string> jump = find_jump(Path(segments), radius_m());
  ASSERT_TRUE(jump);
  EXPECT_THAT(*jump, HasSubstr("segments[1]"));
}

TEST(FindJump, SeesALeapOfTheOrientationToo) {
  std::vector<Segment> segments = tour_segments();
  segments[1].orientation[0] += Vec4(0, 1e-6, 0, 0);
  EXPECT_TRUE(find_jump(Path(segments), radius_m()));
  // Sign and length of a four-vector have no meaning.
  segments = tour_segments();
  for (Vec4& q : segments[1].orientation) q *= -3.0;
  EXPECT_FALSE(find_jump(Path(segments), radius_m()));
}

TEST(FindJump, AcceptsNumbersOfTenDigitsWhateverTheirSize) {
  const auto ten_digits = [](double x) { return std::stod(fmt::format("{:.9e}", x)); };
  for (const double scale : {1e-3, 1.0, 1e6}) {
    // The two ends are rounded separately: the second segment is moved there and back.
    Segment before = straight(0, 1, 2.0 * scale / 3.0, scale / 7.0);
    Segment after = straight(1, 2, scale / 7.0 * (1.0 + 4e-11), scale / 11.0);
    for (Vec3& p : before.position) p = p.unaryExpr(ten_digits);
    for (Vec3& p : after.position) p = p.unaryExpr(ten_digits);
    EXPECT_FALSE(find_jump(Path({before, after}), radius_m())) << scale;
  }
}

TEST(Bridges, AreNotNeededWhereControlPointsAreShared) {
  std::vector<Segment> segments{straight(0, 1, 2, 1), straight(1, 2, 1, 0)};
  EXPECT_TRUE(bridges(Path(segments)).empty());
  for (Vec4& q : segments[1].orientation) q *= -8.0;
  EXPECT_TRUE(bridges(Path(segments)).empty());
}

TEST(Bridges, LeadFromOnePoseToTheOther) {
  std::vector<Segment> segments{straight(0, 1, 2, 1), straight(1, 2, 1, 0)};
  segments[1].position[0].x() += 3e-10;
  segments[1].orientation[0] = Vec4(-3, 1e-10, 0, 0);
  const std::vector<Bridge> found = bridges(Path(segments));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].time_s, 1.0);
  const Segment& over = found[0].path.segments()[0];
  EXPECT_EQ(over.position[0], segments[0].position[3]);
  EXPECT_EQ(over.position[3], segments[1].position[0]);
  EXPECT_EQ(over.orientation[0] * 2.0, segments[0].orientation[6]);
  EXPECT_EQ(over.orientation[6] * -4.0, segments[1].orientation[0]);
}

TEST(Bridges, ShowAWallOfNoThicknessInTheGap) {
  // Both segments stand still, and the wall is between them.
  const Path path({straight(0, 1, 1e-10, 1e-10), straight(1, 2, 0, 0)});
  const double z_m = 0.5e-10 - 0.1;  // the quadrilateral is 0.1 m before the eye
  scene::Mesh wall;
  testing::add_triangle(wall, {-9, -9, z_m}, {9, -9, z_m}, {0, 9, z_m});
  ASSERT_FALSE(find_jump(path, radius_m()));
  const scene::SceneIndex index = scene::SceneIndex::build(wall);
  const auto check = [&](const Path& part) {
    const auto never = base::Deadline::never();
    return check_path({collision::Obstacles(index), motion::Body(testing::small_camera())}, part,
                      never, never);
  };
  EXPECT_TRUE(check(path).certificate.certified);
  const std::vector<Bridge> found = bridges(path);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(check(found[0].path).certificate.certified);
}

TEST(KeyframeMisses, AreRoundingOnOurPathsAndTheMissOnOthers) {
  const Path path(tour_segments());
  std::vector<Keyframe> wanted = keyframes();
  for (const double miss_m : keyframe_misses_m(path, wanted, radius_m())) {
    EXPECT_LE(miss_m, 1e-14);  // a spline's solution and an evaluation, of numbers up to 2
  }
  wanted[1].pose.position.y() += 0.25;
  wanted[2].pose.orientation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()));
  const std::vector<double> misses_m = keyframe_misses_m(path, wanted, radius_m());
  ASSERT_EQ(misses_m.size(), 3u);
  EXPECT_NEAR(misses_m[1], 0.25, 1e-12);
  EXPECT_NEAR(misses_m[2], 0.1 * radius_m(), 1e-4);
}

}  // namespace
}  // namespace camway::planning
