// SPDX-License-Identifier: MIT
//
// Motions and obstacles for which the ends of the collision intervals are known in closed form: a
// plane, a slot, a pole, and a quadrilateral that rotates about the eye.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/collision/crossing_campaign.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::Camera;
using motion::Path;
using motion::Segment;
using scene::Mesh;
using scene::SceneIndex;
using testing::certified_intervals;

constexpr double kPi = std::numbers::pi;
constexpr double kWide_m = 40.0;

// Returns the largest distance between body and obstacle at the end of an interval. The last
// undecided stretch has a deviation of at most the tolerance, and its middle is at most that far
// from the obstacle, so its ends are at most twice that far. The second term is the rounding of the
// detector: a thousand units at 40 m.
double end_distance_m(double tolerance_m) { return 2.0 * tolerance_m + 1000.0 * 0x1p-53 * kWide_m; }

void add_rectangle(Mesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b) {
  testing::add_triangle(mesh, corner, corner + a, corner + a + b);
  testing::add_triangle(mesh, corner, corner + a + b, corner + b);
}

// Add the plane z = `z_m`, y = `y_m` or x = `x_m`, larger than any path here.
void add_z_plane(Mesh& mesh, double z_m) {
  add_rectangle(mesh, {-kWide_m, -kWide_m, z_m}, {2 * kWide_m, 0, 0}, {0, 2 * kWide_m, 0});
}
void add_y_plane(Mesh& mesh, double y_m) {
  add_rectangle(mesh, {-kWide_m, y_m, -kWide_m}, {2 * kWide_m, 0, 0}, {0, 0, 2 * kWide_m});
}

Segment standing(const Vec3& position_W, const Quat& orientation) {
  Segment segment;
  segment.t1_s = 1.0;
  segment.position.fill(position_W);
  segment.orientation.fill(geometry::wxyz(orientation));
  return segment;
}

// Returns a motion with smooth start and stop: the fraction of the way at u is 3u² - 2u³.
Path eased(const Vec3& from, const Vec3& to, const Quat& orientation) {
  Segment segment = standing(from, orientation);
  segment.position = {from, from, to, to};
  return Path({segment});
}

double ease_time_s(double share) { return 0.5 - std::sin(std::asin(1.0 - 2.0 * share) / 3.0); }

// Returns a rotation by `angle_rad` about `axis_C` at the origin. The quaternion moves along the
// chord, so its angle a at u satisfies sin(a) / sin(end - a) = u / (1 - u).
Path chord_turn(const Vec3& axis_C, double angle_rad) {
  const Vec4 from = geometry::wxyz(Quat::Identity());
  const Vec4 to = geometry::wxyz(Quat(Eigen::AngleAxisd(angle_rad, axis_C)));
  Segment segment = standing(Vec3::Zero(), Quat::Identity());
  for (std::size_t i = 0; i < 7; ++i) {
    segment.orientation[i] = from + (static_cast<double>(i) / 6.0) * (to - from);
  }
  return Path({segment});
}

double turn_time_s(double turned_rad, double angle_rad) {
  const double done = std::sin(0.5 * turned_rad);
  return done / (done + std::sin(0.5 * (angle_rad - turned_rad)));
}

// Returns the angle at a time: the inverse of `turn_time_s`.
double turned_rad(double time_s, double angle_rad) {
  const double half = 0.5 * angle_rad;
  return 2.0 * std::atan2(time_s * std::sin(half), 1.0 - time_s + time_s * std::cos(half));
}

// Expects one interval, from `begin_s` to `end_s`. `distance_m` returns the distance of the body
// from the obstacle at a time outside of the interval.
void expect_one_interval(const std::vector<CollisionInterval>& found, double begin_s, double end_s,
                         const std::function<double(double)>& distance_m, double tolerance_m) {
  ASSERT_EQ(found.size(), 1u);
  // The closed form is rounded as well, by fewer than 64 units for times of up to a second.
  constexpr double kTimeRounding_s = 64.0 * 0x1p-53;
  EXPECT_LE(found[0].t_begin_s, begin_s + kTimeRounding_s);
  EXPECT_GE(found[0].t_end_s, end_s - kTimeRounding_s);
  EXPECT_LE(distance_m(found[0].t_begin_s), end_distance_m(tolerance_m));
  EXPECT_LE(distance_m(found[0].t_end_s), end_distance_m(tolerance_m));
}

DetectOptions with_tolerance(double tolerance_m) {
  return {.tolerance_m = tolerance_m, .joining_distance_m = std::max(10.0 * tolerance_m, 2e-3)};
}

class Analytic : public ::testing::TestWithParam<double> {
 protected:
  const double tolerance_m_ = GetParam();
  const DetectOptions options_ = with_tolerance(tolerance_m_);
  const Camera camera_ = testing::small_camera();
  const motion::Corners corners_C_ = motion::near_corners_C(camera_);
  const double half_width_m_ = corners_C_[0].x();
  const double half_height_m_ = corners_C_[0].y();

  [[nodiscard]] std::vector<CollisionInterval> detect(const Mesh& mesh, const Path& path) const {
    return certified_intervals(Obstacles(SceneIndex::build(mesh)), path, camera_, options_);
  }
};

TEST_P(Analytic, PlaneMetByATiltedQuadrilateralThatAccelerates) {
  Mesh mesh;
  add_z_plane(mesh, 0.0);
  testing::Random random(31);
  for (int run = 0; run < 50; ++run) {
    const Quat orientation = random.rotation();
    double lowest_m = 1.0;
    double highest_m = -1.0;
    for (const Vec3& corner_C : corners_C_) {
      lowest_m = std::min(lowest_m, (orientation * corner_C).z());
      highest_m = std::max(highest_m, (orientation * corner_C).z());
    }
    const auto height_m = [](double t) { return 2.0 - 4.0 * (3.0 * t * t - 2.0 * t * t * t); };
    SCOPED_TRACE(run);
    expect_one_interval(
        detect(mesh, eased({0, 0, 2}, {0, 0, -2}, orientation)),
        ease_time_s((2.0 + lowest_m) / 4.0), ease_time_s((2.0 + highest_m) / 4.0),
        [&](double t) {
          return std::max({0.0, height_m(t) + lowest_m, -(height_m(t) + highest_m)});
        },
        tolerance_m_);
  }
}

// A camera that rolls in a slot between floor and ceiling is free while it is nearly level: it
// needs half_width·|sin φ| + half_height·|cos φ| above and below.
TEST_P(Analytic, SlotInWhichTheCameraRolls) {
  const double diagonal_m = std::hypot(half_width_m_, half_height_m_);
  const double level_rad = std::atan2(half_height_m_, half_width_m_);
  const double angle_rad = 0.5 * kPi;
  const Path path = chord_turn(Vec3::UnitZ(), angle_rad);
  for (const double share : {0.1, 0.5, 0.9, 0.999}) {
    // A height between that of the level camera and that of its diagonal, which is upright in
    // between.
    const double half_slot_m = half_height_m_ + share * (diagonal_m - half_height_m_);
    Mesh mesh;
    add_y_plane(mesh, half_slot_m);
    add_y_plane(mesh, -half_slot_m);
    const auto needed_m = [&](double t) {
      return diagonal_m * std::sin(turned_rad(t, angle_rad) + level_rad);
    };
    const double reach_rad = std::asin(half_slot_m / diagonal_m);
    const double last_rad = kPi - reach_rad - level_rad;
    SCOPED_TRACE(share);
    expect_one_interval(
        detect(mesh, path), turn_time_s(reach_rad - level_rad, angle_rad),
        last_rad < angle_rad ? turn_time_s(last_rad, angle_rad) : 1.0,
        [&](double t) { return std::max(0.0, half_slot_m - needed_m(t)); }, tolerance_m_);
  }
}

TEST_P(Analytic, SlotThatIsWideEnoughIsFreeAndOneThatIsNotIsNot) {
  const double diagonal_m = std::hypot(half_width_m_, half_height_m_);
  const Path path = chord_turn(Vec3::UnitZ(), 0.5 * kPi);
  Mesh wide;
  Mesh narrow;
  for (const double side : {-1.0, 1.0}) {
    add_y_plane(wide, side * (diagonal_m + 1.01 * tolerance_m_));
    add_y_plane(narrow, side * (diagonal_m - 1e-3 * tolerance_m_));
  }
  EXPECT_TRUE(detect(wide, path).empty());
  EXPECT_EQ(detect(narrow, path).size(), 1u);
}

// A quadrilateral that is rotated about the vertical flies straight at a vertical triangular pole,
// which is thinner than the distance between two samples of any sampled check.
TEST_P(Analytic, PoleOfKnownPlace) {
  testing::Random random(32);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int run = 0; run < 50; ++run) {
    const double thickness_m = 1e-4;
    const std::array<Vec3, 3> profile{Vec3(0, 0, 0), Vec3(thickness_m, 0, 0.3 * thickness_m),
                                      Vec3(0.2 * thickness_m, 0, thickness_m)};
    Mesh mesh;
    for (std::size_t i = 0; i < 3; ++i) {
      add_rectangle(mesh, profile[i] - Vec3(0, 1, 0), profile[(i + 1) % 3] - profile[i],
                    Vec3(0, 2, 0));
    }
    const double yaw_rad = 0.9 * share(random);
    const Quat orientation(Eigen::AngleAxisd(yaw_rad, Vec3::UnitY()));
    const Vec3 step_scale = orientation * Vec3(0, 0, -1);
    const Vec3 aside = orientation * Vec3(1, 0, 0);
    const Vec3 start = -step_scale + 0.5 * half_width_m_ * share(random) * aside;
    double first_m = 1.0;
    double last_m = -1.0;
    for (const Vec3& point : profile) {
      first_m = std::min(first_m, step_scale.dot(point - start) - camera_.near_m);
      last_m = std::max(last_m, step_scale.dot(point - start) - camera_.near_m);
    }
    const auto travelled_m = [](double t) { return 2.0 * (3.0 * t * t - 2.0 * t * t * t); };
    SCOPED_TRACE(run);
    expect_one_interval(
        detect(mesh, eased(start, start + 2.0 * step_scale, orientation)),
        ease_time_s(first_m / 2.0), ease_time_s(last_m / 2.0),
        [&](double t) {
          return std::max({0.0, first_m - travelled_m(t), travelled_m(t) - last_m});
        },
        tolerance_m_);
  }
}

// During a rotation by 175° about the vertical, a side of the quadrilateral moves on a circle of
// its own radius. It touches a wall ahead while the angle between side and wall is small enough.
TEST_P(Analytic, SpinningQuadrilateralReachesAWall) {
  const double angle_rad = 175.0 * kPi / 180.0;
  const double radius_m = std::hypot(half_width_m_, camera_.near_m);
  const double side_rad = std::atan2(half_width_m_, camera_.near_m);
  const Path path = chord_turn(Vec3::UnitY(), angle_rad);
  // A rotation about +Y leads from -Z to -X. The right side is ahead of -Z by `side_rad`, towards
  // +X, and so meets a wall at -X last; the left side meets it first.
  const double wall_rad = 0.5 * kPi;
  for (const double share : {0.3, 0.9, 0.9999}) {
    const double wall_m = camera_.near_m + share * (radius_m - camera_.near_m);
    Mesh mesh;
    add_rectangle(mesh, {-wall_m, -kWide_m, -kWide_m}, {0, 2 * kWide_m, 0}, {0, 0, 2 * kWide_m});
    const double open_rad = std::acos(wall_m / radius_m);
    const auto reach_m = [&](double t) {
      const double turned = turned_rad(t, angle_rad);
      return radius_m * std::max(std::cos(wall_rad - turned - side_rad),
                                 std::cos(wall_rad - turned + side_rad));
    };
    const double begin_s = turn_time_s(wall_rad - side_rad - open_rad, angle_rad);
    const double left_gone_s = turn_time_s(wall_rad - side_rad + open_rad, angle_rad);
    const double right_comes_s = turn_time_s(wall_rad + side_rad - open_rad, angle_rad);
    const double end_s = turn_time_s(wall_rad + side_rad + open_rad, angle_rad);
    const std::vector<CollisionInterval> found = detect(mesh, path);
    const auto distance_m = [&](double t) { return std::max(0.0, wall_m - reach_m(t)); };
    SCOPED_TRACE(share);
    ASSERT_EQ(found.size(), 2u);
    expect_one_interval({found[0]}, begin_s, left_gone_s, distance_m, tolerance_m_);
    expect_one_interval({found[1]}, right_comes_s, end_s, distance_m, tolerance_m_);
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, Analytic, ::testing::Values(1e-3, 1e-4, 1e-6));

}  // namespace
}  // namespace camway::collision
