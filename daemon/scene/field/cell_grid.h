// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

namespace camway::scene {

/// A box around a scene, divided into cubic cells. Cell (x, y, z) is the closed cube of the points
/// p with `(p - low_W) / resolution_m` in [x, x+1] x [y, y+1] x [z, z+1]. A value type.
///
/// The grid begins where the scene begins, not at the origin like `VoxelGrid`, whose voxels are
/// those of OctoMap. So its rounding errors do not grow with the scene's distance from the origin.
struct CellGrid {
  /// Largest number of cells along a side.
  static constexpr std::int32_t kMaxSide = 1 << 15;

  geometry::Vec3 low_W;  ///< lowest corner of cell (0, 0, 0)
  double resolution_m = 0.0;
  double cells_per_m = 0.0;  ///< 1 / resolution_m, rounded
  std::array<std::int32_t, 3> size{};

  /// The grid of this resolution around `bounds`. It leaves half a cell or more between `bounds`
  /// and its faces (a quarter, rounding included). So the planes that bound most scenes (floor,
  /// ceiling, outer walls) lie in the half of their cells that faces the scene. Returns nothing if
  /// `bounds` is empty, the resolution is outside `VoxelGrid`'s limits, a side would have more than
  /// kMaxSide cells, or doubles are too coarse at `bounds` to tell the cells apart.
  static std::optional<CellGrid> around(const geometry::Box& bounds, double resolution_m);

  [[nodiscard]] std::size_t cells() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }

  /// Converts `point_W` to cells. For a point of the grid each coordinate is off by at most
  /// `coordinate_error_cells()`.
  [[nodiscard]] geometry::Vec3 in_cells(const geometry::Vec3& point_W) const {
    return (point_W - low_W) * cells_per_m;
  }

  /// Error bound of `in_cells`. The difference, the reciprocal and the product round by a relative
  /// 2^-53 each: 3 units of the coordinate, to first order. The fourth covers the second order.
  [[nodiscard]] double coordinate_error_cells() const {
    return 4.0 * geometry::kUnitRoundoff * longest_side();
  }

  [[nodiscard]] std::int32_t longest_side() const;
};

}  // namespace camway::scene
