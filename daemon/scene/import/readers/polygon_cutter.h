// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace camway::scene::mesh_readers {

using Point = std::array<double, 3>;

/// Cuts polygons into triangles by their corners, by cutting ears (Meisters 1975, "Polygons have
/// ears"): a planar polygon whose outline does not meet itself, convex or not, is covered exactly.
/// All decisions are exact: the polygon is looked at along the axis to which its normal (Newell) is
/// nearest, which drops a coordinate and rounds nothing, and orientations of three corners are
/// computed without rounding.
///
/// Of a polygon that is not quite planar the same is true in that view; in space the triangles span
/// its corners. Where the outline meets itself no surface is defined: what is left when no ear is
/// found is cut into a fan, so that nothing is left out. Not safe from two threads at once.
class PolygonCutter {
 public:
  using Cut = std::array<std::uint32_t, 3>;  ///< three of the corners

  /// `corners.size() - 2` triangles in the polygon's sense of turning, valid until the next call.
  /// Preconditions: 3 corners or more; each coordinate is 0 or its magnitude within 2^±200, or
  /// else what is said above of exactness does not hold.
  std::span<const Cut> cut(std::span<const Point> corners);

 private:
  using Index = std::uint32_t;

  /// Sets `points_` so that the polygon turns counter-clockwise.
  void project(std::span<const Point> corners);
  void link();
  void cut_quadrilateral();
  void cut_ears();
  void cut_fan(Index first, std::size_t remaining);
  void unlink(Index ear);
  [[nodiscard]] double turn(Index a, Index b, Index c) const;
  [[nodiscard]] double turn_at(Index corner) const;
  [[nodiscard]] bool is_ear(Index corner) const;
  [[nodiscard]] bool encloses(const Cut& ear, Index corner) const;

  std::vector<std::array<double, 2>> points_;
  std::vector<Index> before_;  ///< the corners that are left, as a ring
  std::vector<Index> after_;
  std::vector<Index>
      reflex_;  ///< corners that are not strictly convex; only these can be in an ear
  std::vector<Cut> cuts_;
};

/// Above 0 if a, b, c turn counter-clockwise, below 0 if clockwise, 0 if they are on a line: the
/// sign is exact (Shewchuk 1997, "Adaptive precision floating-point arithmetic", section 4.1, with
/// but one stage after the filter), as long as nothing over- or underflows.
double orientation(const std::array<double, 2>& a, const std::array<double, 2>& b,
                   const std::array<double, 2>& c);

}  // namespace camway::scene::mesh_readers
