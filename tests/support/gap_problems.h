// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/smoothing/smoothing_form.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"

/// Inputs of the correction of one interval between keyframes, made in memory.
namespace camway::testing {

/// A random generator for tests.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seeded(seed)) {}

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int integer(int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(generator_);
  }
  Vec3 vector(double size) {
    return {number(-size, size), number(-size, size), number(-size, size)};
  }
  geometry::Vec4 image(double size) {
    return {number(-size, size), number(-size, size), number(-size, size), number(-size, size)};
  }
  Quat turn(double largest_rad) {
    return Quat(Eigen::AngleAxisd(number(0.0, largest_rad), vector(1.0).normalized()));
  }
  correction::StackedPoint stacked(double size) {
    correction::StackedPoint result;
    for (Eigen::Index i = 0; i < 7; ++i) result[i] = number(-size, size);
    return result;
  }
  correction::StackedPoints points(Eigen::Index count, double size) {
    correction::StackedPoints result(count, 7);
    for (Eigen::Index i = 0; i < count; ++i) result.row(i) = stacked(size).transpose();
    return result;
  }
  std::mt19937_64& generator() { return generator_; }

 private:
  std::mt19937_64 generator_;
};

/// Returns the problem of one interval between keyframes, on a path that is still as interpolated.
inline correction::Problem problem_of_gap(const std::vector<motion::Keyframe>& keyframes,
                                          std::size_t gap) {
  const motion::CubicPath whole = motion::interpolate_cubic(keyframes);
  const std::size_t first = gap == 0 ? 0 : gap - 1;
  const std::size_t last = std::min(gap + 2, keyframes.size() - 1);
  correction::Problem problem;
  problem.path = whole.around(keyframes[first].time_s, keyframes[last].time_s);
  problem.original = problem.path;
  for (std::size_t i = first; i <= last; ++i) problem.keyframes_s.push_back(keyframes[i].time_s);
  problem.gap = gap - first;
  problem.has_path_begin = first == 0;
  problem.has_path_end = last + 1 == keyframes.size();
  problem.interval = {keyframes[gap].time_s, keyframes[gap + 1].time_s};
  return problem;
}

inline std::vector<motion::Keyframe> random_keyframes(Draw& draw, int count) {
  std::vector<motion::Keyframe> keyframes;
  double time_s = draw.number(-5.0, 5.0);
  for (int i = 0; i < count; ++i) {
    keyframes.push_back({time_s, {draw.vector(2.0), draw.turn(1.5)}});
    time_s += draw.number(0.3, 2.0);
  }
  return keyframes;
}

}  // namespace camway::testing
