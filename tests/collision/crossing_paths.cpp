// SPDX-License-Identifier: MIT
#include "tests/collision/crossing_paths.h"

#include <numbers>
#include <vector>

#include "daemon/motion/spline/interpolate.h"

namespace camway::testing {

namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::Keyframe;
using motion::Path;
using motion::Pose;
using motion::Segment;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Returns the same curves with segments of one second.
Path a_second_each(const Path& path) {
  std::vector<Segment> segments(path.segments().begin(), path.segments().end());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    segments[i].t0_s = static_cast<double>(i);
    segments[i].t1_s = static_cast<double>(i + 1);
  }
  return Path(std::move(segments));
}

Quat turned_by(Random& random, const Quat& from, double most_rad) {
  const Vec3 axis = random.direction();
  return Quat(Eigen::AngleAxisd(random.uniform(0.0, most_rad), axis)) * from;
}

Path smooth_path(Random& random, const Vec3& place_W, double size_m) {
  std::vector<Keyframe> keyframes;
  Pose pose{place_W, random.rotation()};
  const int count = random.integer(3, 4);
  for (int i = 0; i < count; ++i) {
    keyframes.push_back({static_cast<double>(i), pose});
    pose.position += size_m * random.uniform(0.2, 1.0) * random.direction();
    pose.orientation = turned_by(random, pose.orientation, 100.0 * kRadPerDeg);
  }
  return a_second_each(motion::interpolate(keyframes));
}

// Returns joined segments with kinks: the proof requires continuity only.
Path free_path(Random& random, const Vec3& place_W, double size_m) {
  std::vector<Segment> segments(2);
  Vec3 position = place_W;
  Vec4 orientation = geometry::wxyz(random.rotation());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    segments[s].t0_s = static_cast<double>(s);
    segments[s].t1_s = static_cast<double>(s + 1);
    for (std::size_t i = 0; i < 4; ++i) {
      segments[s].position[i] = position;
      if (i < 3) position += 0.4 * size_m * random.normal_vector(1.0);
    }
    const double spread = random.uniform(0.0, 0.12);
    for (std::size_t i = 0; i < 7; ++i) {
      segments[s].orientation[i] = orientation;
      const Vec4 step(random.normal(), random.normal(), random.normal(), random.normal());
      if (i < 6) orientation += spread * step;
    }
  }
  return Path(std::move(segments));
}

}  // namespace

motion::Camera random_camera(Random& random) {
  return {.fov_x_rad = random.uniform(20.0, 120.0) * kRadPerDeg,
          .fov_y_rad = random.uniform(20.0, 120.0) * kRadPerDeg,
          .near_m = random.log_uniform(1e-3, 1.0)};
}

Vec3 random_place(Random& random) {
  switch (random.integer(0, 3)) {
    case 0:
      return 1e6 * random.direction();
    case 1:
      return random.log_uniform(1.0, 1e3) * random.direction();
    default:
      return Vec3::Zero();
  }
}

Path uniform_path(const Pose& from, const Vec3& to_W) {
  return a_second_each(
      motion::interpolate(std::vector<Keyframe>{{0.0, from}, {1.0, {to_W, from.orientation}}}));
}

Path turning_path(const Pose& from, const Vec3& axis_C, double angle_rad) {
  const Quat to = from.orientation * Quat(Eigen::AngleAxisd(angle_rad, axis_C));
  return a_second_each(
      motion::interpolate(std::vector<Keyframe>{{0.0, from}, {1.0, {from.position, to}}}));
}

Path random_path(Random& random, PathKind kind, const Vec3& place_W, double size_m) {
  switch (kind) {
    case PathKind::kStraight:
      return uniform_path({place_W, random.rotation()}, place_W + size_m * random.direction());
    case PathKind::kSpin:
      return turning_path({place_W, random.rotation()}, random.direction(),
                          random.uniform(20.0, 170.0) * kRadPerDeg);
    case PathKind::kSmooth:
      return smooth_path(random, place_W, size_m);
    case PathKind::kFree:
      break;
  }
  return free_path(random, place_W, size_m);
}

}  // namespace camway::testing
