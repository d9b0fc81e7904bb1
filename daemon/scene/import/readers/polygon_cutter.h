// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace camway::scene::mesh_readers {

using Point = std::array<double, 3>;

/// Cuts polygons into triangles between their corners, by cutting ears (Meisters 1975, "Polygons
/// have ears"). It covers a planar polygon whose outline does not meet itself, convex or not,
/// exactly. All decisions are exact: the polygon is projected along the axis nearest to its normal
/// (Newell), which drops a coordinate and rounds nothing, and orientations of three corners are
/// exact.
///
/// For a polygon that is not quite planar the same holds in the projection; in space the triangles
/// span its corners. An outline that meets itself defines no surface: the remainder without an ear
/// is cut into a fan, so that nothing is left out.
/// Not thread-safe.
class PolygonCutter {
 public:
  using Cut = std::array<std::uint32_t, 3>;  ///< indices of three corners

  /// Returns `corners.size() - 2` triangles that turn like the polygon, valid until the next call.
  /// Requires 3 corners or more. The exactness above requires that each coordinate is 0 or has a
  /// magnitude within 2^±200.
  std::span<const Cut> cut(std::span<const Point> corners);

  /// The same for a polygon with holes: `corners` are those of the outline and then those of each
  /// hole, up to each of `ends`. Bridges lead from the outline to the holes, which do not cut any
  /// edge (Held 2001, "FIST: Fast industrial-strength triangulation of polygons", section 3.2).
  /// Returns no triangle if a hole cannot be reached: it is not inside, or outlines meet. Requires
  /// that each outline has 3 corners or more.
  std::span<const Cut> cut(std::span<const Point> corners, std::span<const std::size_t> ends);

 private:
  using Index = std::uint32_t;

  /// Sets `points_` so that the polygon of the first `outline` corners turns counter-clockwise.
  void project(std::span<const Point> corners, std::size_t outline);
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
  std::vector<Index> before_;  ///< the remaining corners, as a ring
  std::vector<Index> after_;
  std::vector<Index> reflex_;  ///< corners not strictly convex; only these can lie in an ear
  std::vector<Cut> cuts_;
};

/// The sign of the turn a, b, c: above 0 if counter-clockwise, below 0 if clockwise, 0 on a line.
/// It is exact as long as nothing over- or underflows (Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic", section 4.1). Deviation: only one stage after the filter.
double orientation(const std::array<double, 2>& a, const std::array<double, 2>& b,
                   const std::array<double, 2>& c);

}  // namespace camway::scene::mesh_readers
