// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A line segment through a narrow place.
struct HoleLine {
  geometry::Vec3 begin_W;
  geometry::Vec3 end_W;

  [[nodiscard]] geometry::Vec3 center_W() const { return 0.5 * (begin_W + end_W); }
  [[nodiscard]] double length_m() const { return (end_W - begin_W).norm(); }
  [[nodiscard]] geometry::Vec3 direction_W() const { return (end_W - begin_W).normalized(); }
};

/// The line of this half length, in radii of the body's ball, about a point.
HoleLine line_about(const FreeSpace& space, const geometry::Vec3& center_W,
                    const geometry::Vec3& along_W, double half_length);

/// Room about the line, at most the radius of the body's ball. [Units: metres]
double room_m(const FreeSpace& space, const HoleLine& line);

/// Shifts the ends of the line to where there is more room.
HoleLine widened(const FreeSpace& space, HoleLine line);

/// Equidistant places on the line, both ends included.
std::vector<geometry::Vec3> places_on(const HoleLine& line);

/// The place with the least room. [Limit: one place or more]
geometry::Vec3 tightest(const FreeSpace& space, std::span<const geometry::Vec3> places_W);

/// Price of a shift of the body from a line: the farther, the likelier beside the narrow place. In
/// the scale of the body, for a shift by the radius of its ball. Chosen by measurement.
inline constexpr double kBesideLine = 0.5;

/// A direction across a line, and the vector from the line to the middle of the free space in that
/// direction.
struct Side {
  geometry::Vec3 direction_W;
  geometry::Vec3 to_middle_W;
};
inline constexpr std::size_t kSides = 48;  ///< directions in a full turn; a multiple of four

/// The `kSides` directions across the line, in equal steps of a full turn.
std::vector<Side> sides_of(const FreeSpace& space, const HoleLine& line);

}  // namespace camway::correction
