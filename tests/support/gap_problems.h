// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/smoothing/smoothing_form.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

/// Inputs of the correction of one interval between keyframes, made in memory.
namespace camway::testing {

/// Random values of the types that corrections work on.
class Draw : public Random {
 public:
  using Random::Random;

  geometry::Vec4 image(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Quat turn(double largest_rad) {
    return Quat(Eigen::AngleAxisd(uniform(0.0, largest_rad), in_cube(1.0).normalized()));
  }
  correction::StackedPoint stacked(double size) {
    correction::StackedPoint result;
    for (Eigen::Index i = 0; i < 7; ++i) result[i] = uniform(-size, size);
    return result;
  }
  correction::StackedPoints points(Eigen::Index count, double size) {
    correction::StackedPoints result(count, 7);
    for (Eigen::Index i = 0; i < count; ++i) result.row(i) = stacked(size).transpose();
    return result;
  }
};

/// Returns the problem of one interval between keyframes, on a path that is still as interpolated.
inline correction::Problem problem_of_leg(const std::vector<motion::Keyframe>& keyframes,
                                          std::size_t gap) {
  const motion::CubicPath whole = motion::interpolate_cubic(keyframes);
  const std::size_t first = gap == 0 ? 0 : gap - 1;
  const std::size_t last = std::min(gap + 2, keyframes.size() - 1);
  correction::Problem problem;
  problem.path = whole.around(keyframes[first].time_s, keyframes[last].time_s);
  problem.original = problem.path;
  for (std::size_t i = first; i <= last; ++i) problem.keyframes_s.push_back(keyframes[i].time_s);
  problem.leg = gap - first;
  problem.has_path_begin = first == 0;
  problem.has_path_end = last + 1 == keyframes.size();
  problem.interval = {keyframes[gap].time_s, keyframes[gap + 1].time_s};
  return problem;
}

/// Returns the problem of a straight path along z, from 4 to -4 in 8 s, without turning.
inline correction::Problem problem_along_z() {
  const auto at = [](double time_s, double z_m) {
    return motion::Keyframe{time_s, {{0, 0, z_m}, geometry::Quat::Identity()}};
  };
  return problem_of_leg({at(0, 4), at(8, -4)}, 0);
}

/// Adds a plate across that path at z = 0, which reaches `height_m` into the way of the near
/// quadrilateral of `small_camera()`, from below.
inline void add_plate_across(scene::Mesh& mesh, double height_m, double thickness_m) {
  const motion::Camera camera = small_camera();
  const double low_m = -std::tan(camera.fov_y_rad / 2.0) * camera.near_m;
  add_cuboid(mesh, {-3, -3, -0.5 * thickness_m}, {3, low_m + height_m, 0.5 * thickness_m});
}

/// Adds a wall at z = 0 that ends at x = 6. Its window, 0.9 m wide at (0.5, 0.5), lies between
/// points that are whole metres.
inline void add_wall_with_window(scene::Mesh& mesh) {
  add_cuboid(mesh, {-20, -20, -0.1}, {6, 0.05, 0.1});
  add_cuboid(mesh, {-20, 0.95, -0.1}, {6, 20, 0.1});
  add_cuboid(mesh, {-20, 0.05, -0.1}, {0.05, 0.95, 0.1});
  add_cuboid(mesh, {0.95, 0.05, -0.1}, {6, 0.95, 0.1});
}

inline std::vector<motion::Keyframe> random_keyframes(Draw& draw, int count) {
  std::vector<motion::Keyframe> keyframes;
  double time_s = draw.uniform(-5.0, 5.0);
  for (int i = 0; i < count; ++i) {
    keyframes.push_back({time_s, {draw.in_cube(2.0), draw.turn(1.5)}});
    time_s += draw.uniform(0.3, 2.0);
  }
  return keyframes;
}

}  // namespace camway::testing
