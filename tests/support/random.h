// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>

#include "daemon/geometry/types.h"

namespace camway::testing {

/// The random source of all tests. Prints its seed, so that a failure can be repeated. The numbers
/// of its own functions are the same with every standard library; those of the distributions of
/// `<random>`, to which it can be handed, are not.
class Random {
 public:
  using result_type = std::uint64_t;

  explicit Random(std::uint64_t seed) : engine_(seed) {
    // Outside of a test, as where parameters of tests are made, nothing may be printed: the output
    // of --gtest_list_tests is read by CTest.
    if (::testing::UnitTest::GetInstance()->current_test_info() == nullptr) return;
    std::printf("[   SEED   ] %llu\n", static_cast<unsigned long long>(seed));
  }

  /// Returns the source of case `index` of a campaign. It depends on nothing else, so that cases
  /// can be made in any order and by any thread. Prints nothing.
  static Random of_case(std::uint64_t seed, std::uint64_t index) {
    return Random(std::mt19937_64(mixed(mixed(seed) + index)));
  }

  static constexpr result_type min() { return std::mt19937_64::min(); }
  static constexpr result_type max() { return std::mt19937_64::max(); }
  result_type operator()() { return engine_(); }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1.0p-53);
  }
  /// Returns a number with a uniformly distributed logarithm. Requires 0 < low <= high.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  /// Returns a number of the standard normal distribution, by the transform of Box and Muller
  /// (1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * std::numbers::pi));
  }
  /// Returns an integer from `low` to `high`, both included.
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  /// Returns a point of the cube of side 2 * `half` about the origin.
  geometry::Vec3 in_cube(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  /// Returns a vector whose coordinates are normally distributed with this standard deviation.
  geometry::Vec3 normal_vector(double deviation) {
    const double x = deviation * normal();
    const double y = deviation * normal();
    return {x, y, deviation * normal()};
  }
  geometry::Vec3 direction() { return normal_vector(1.0).normalized(); }
  /// Returns a rotation; all are equally likely.
  geometry::Quat rotation() {
    const double w = normal();
    const geometry::Vec3 v = normal_vector(1.0);
    return geometry::Quat(w, v.x(), v.y(), v.z()).normalized();
  }

 private:
  explicit Random(const std::mt19937_64& engine) : engine_(engine) {}

  /// The finalizer of SplitMix64 (Steele, Lea & Flood 2014): neighbouring seeds become unrelated.
  static std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  std::mt19937_64 engine_;
};

}  // namespace camway::testing
