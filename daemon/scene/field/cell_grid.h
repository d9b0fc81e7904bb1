// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

namespace camway::scene {

/// A box around a scene, cut into cubic cells. Cell (x, y, z) is the closed cube of the points p
/// with `(p - low_W) / resolution_m` in [x, x+1] x [y, y+1] x [z, z+1]. A value type.
///
/// Other than `VoxelGrid`, whose voxels are those of OctoMap, it begins where the scene begins: its
/// rounding errors do not grow with the scene's distance from the origin.
struct CellGrid {
  /// No side has more cells than this.
  static constexpr std::int32_t kMaxSide = 1 << 15;

  geometry::Vec3 low_W;  ///< lowest corner of cell (0, 0, 0)
  double resolution_m = 0.0;
  double cells_per_m = 0.0;  ///< 1 / resolution_m, rounded
  std::array<std::int32_t, 3> size{};

  /// The grid of this resolution around `bounds`, which stays at least a quarter of a cell away
  /// from the grid's faces, and half a cell but for rounding: so the planes that bound most scenes
  /// (floor, ceiling, outer walls) lie in the outer half of their cells. Nothing where `bounds` is
  /// empty, the resolution is outside `VoxelGrid`'s limits, a side would have more than kMaxSide
  /// cells, or doubles are too coarse at `bounds` to tell the cells apart.
  static std::optional<CellGrid> around(const geometry::Box& bounds, double resolution_m);

  [[nodiscard]] std::size_t cells() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }

  /// Where `point_W` is, in cells; each coordinate is off by at most `coordinate_error_cells()` for
  /// a point of the grid.
  [[nodiscard]] geometry::Vec3 in_cells(const geometry::Vec3& point_W) const {
    return (point_W - low_W) * cells_per_m;
  }

  /// The difference, the reciprocal and the product round by a relative 2^-53 each: 3 units of the
  /// coordinate, to first order. The fourth is for what is of second order.
  [[nodiscard]] double coordinate_error_cells() const {
    return 4.0 * geometry::kUnitRoundoff * longest_side();
  }

  [[nodiscard]] std::int32_t longest_side() const;
};

}  // namespace camway::scene
