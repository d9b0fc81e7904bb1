// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "daemon/geometry/types.h"

namespace camway::testing {

/// A random generator that is cheap to seed, so that each case of a campaign has its own, and cases
/// can be made in any order and by any thread. Its numbers are the same with every standard
/// library. Source: Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators".
class CaseRandom {
 public:
  CaseRandom(std::uint64_t seed, std::uint64_t index) : state_(seed * kGamma + index) {
    state_ = next() ^ (index << 32U);
    next();
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11U) * 0x1.0p-53);
  }
  /// Returns a number with an evenly distributed logarithm. [Limit: 0 < low <= high]
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * std::numbers::pi));
  }
  geometry::Vec3 vector() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }
  geometry::Vec3 direction() { return vector().normalized(); }
  geometry::Quat rotation() {
    const double w = normal();
    const geometry::Vec3 v = vector();
    return geometry::Quat(w, v.x(), v.y(), v.z()).normalized();
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9e3779b97f4a7c15U;

  std::uint64_t next() {
    std::uint64_t z = (state_ += kGamma);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  std::uint64_t state_;
};

}  // namespace camway::testing
