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

/// An axis-aligned box in the world that a body must not leave; any side may be at infinity.
/// Without limits by default. [Units: metres]
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
  /// The coordinate of a side; infinite if it is no limit.
  [[nodiscard]] double limit_m(std::size_t side) const {
    const auto axis = static_cast<Eigen::Index>(side % 3);
    return side < 3 ? min_W[axis] : max_W[axis];
  }

  /// Depth of `point_W` inside a side; negative outside. One difference of doubles: its sign is
  /// exact, and its error is at most half an epsilon of itself. Infinite if the side is no limit.
  [[nodiscard]] double depth_m(std::size_t side, const Vec3& point_W) const {
    const auto axis = static_cast<Eigen::Index>(side % 3);
    return side < 3 ? point_W[axis] - min_W[axis] : max_W[axis] - point_W[axis];
  }
  /// The least depth over all sides.
  [[nodiscard]] double depth_m(const Vec3& point_W) const {
    return std::min((point_W - min_W).minCoeff(), (max_W - point_W).minCoeff());
  }

  /// Unit normal of a side, pointing inside.
  static Vec3 inward(std::size_t side) {
    return (side < 3 ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(side % 3));
  }

  /// The intersection of both bounds.
  [[nodiscard]] Bounds within(const Bounds& other) const {
    return {min_W.cwiseMax(other.min_W), max_W.cwiseMin(other.max_W)};
  }
  /// These bounds with every side moved inside by `margin_m`.
  [[nodiscard]] Bounds shrunk_by(double margin_m) const {
    return {min_W.array() + margin_m, max_W.array() - margin_m};
  }

  bool operator==(const Bounds&) const = default;
};

/// Bounds with nothing for a side without a limit: the form of files, of messages and of the
/// client.
struct OptionalBounds {
  std::array<std::optional<double>, 3> min_m;
  std::array<std::optional<double>, 3> max_m;
};
OptionalBounds optional_bounds_of(const Bounds& bounds);
Bounds bounds_of(const OptionalBounds& limits);

/// A fault of bounds.
struct BoundsFault {
  std::string field;   ///< field below the bounds, e.g. "min[0]"
  std::string reason;  ///< e.g. "is not a number"
};

/// Returns nothing if no side is "not a number", no finite side is farther from the origin than
/// `kMaxBound_m`, and there is room between the sides.
std::optional<BoundsFault> fault_in(const Bounds& bounds);
inline constexpr double kMaxBound_m = 1e9;

}  // namespace camway::geometry
