// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// A box along the axes of the world, of which any side may be at infinity: what a body must not
/// leave. Without limits by default. [Units: metres]
struct Bounds {
  Vec3 min_W = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 max_W = Vec3::Constant(std::numeric_limits<double>::infinity());

  /// Sides are numbered min.x, min.y, min.z, max.x, max.y, max.z.
  static constexpr std::size_t kSides = 6;
  static constexpr std::array<std::string_view, kSides> kSideNames = {"min.x", "min.y", "min.z",
                                                                      "max.x", "max.y", "max.z"};

  /// Whether any side is a limit.
  [[nodiscard]] bool any() const {
    return (min_W.array() > -std::numeric_limits<double>::infinity()).any() ||
           (max_W.array() < std::numeric_limits<double>::infinity()).any();
  }
  /// The coordinate of a side; infinite where it is no limit.
  [[nodiscard]] double limit_m(std::size_t side) const {
    const auto axis = static_cast<Eigen::Index>(side % 3);
    return side < 3 ? min_W[axis] : max_W[axis];
  }

  /// How far `point_W` is inside of a side; below 0 outside. One difference of doubles: its sign is
  /// right, and it is off by half of an epsilon of itself at most. Infinity where there is no
  /// limit.
  [[nodiscard]] double depth_m(std::size_t side, const Vec3& point_W) const {
    const auto axis = static_cast<Eigen::Index>(side % 3);
    return side < 3 ? point_W[axis] - min_W[axis] : max_W[axis] - point_W[axis];
  }
  /// The least of all sides.
  [[nodiscard]] double depth_m(const Vec3& point_W) const {
    return std::min((point_W - min_W).minCoeff(), (max_W - point_W).minCoeff());
  }

  /// Unit vector that leads inside.
  static Vec3 inward(std::size_t side) {
    return (side < 3 ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(side % 3));
  }

  /// What lies within both.
  [[nodiscard]] Bounds within(const Bounds& other) const {
    return {min_W.cwiseMax(other.min_W), max_W.cwiseMin(other.max_W)};
  }
  /// With every side moved inside.
  [[nodiscard]] Bounds shrunk_by(double margin_m) const {
    return {min_W.array() + margin_m, max_W.array() - margin_m};
  }

  bool operator==(const Bounds&) const = default;
};

/// What is wrong with bounds.
struct BoundsFault {
  std::string field;   ///< below the bounds, e.g. "min[0]"
  std::string reason;  ///< e.g. "is not a number"
};

/// Nothing if no side is "not a number" or further from the origin than `kMaxBound_m`, infinity
/// apart, and there is room between the sides.
std::optional<BoundsFault> fault_in(const Bounds& bounds);
inline constexpr double kMaxBound_m = 1e9;

}  // namespace camway::geometry
