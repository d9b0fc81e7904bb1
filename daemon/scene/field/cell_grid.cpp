// SPDX-License-Identifier: MIT
#include "daemon/scene/field/cell_grid.h"

#include <algorithm>
#include <cmath>

#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {

std::optional<CellGrid> CellGrid::around(const geometry::Box& bounds, double resolution_m) {
  if (bounds.isEmpty() || !VoxelGrid::valid_resolution(resolution_m)) return std::nullopt;
  CellGrid grid;
  grid.resolution_m = resolution_m;
  grid.cells_per_m = 1.0 / resolution_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = static_cast<Eigen::Index>(axis);
    const double extent_m = bounds.max()[i] - bounds.min()[i];
    const double side = std::ceil(extent_m * grid.cells_per_m) + 1.0;
    if (!(side <= kMaxSide)) return std::nullopt;
    grid.size[axis] = static_cast<std::int32_t>(side);
    grid.low_W[i] = bounds.min()[i] - 0.5 * (side * resolution_m - extent_m);
  }
  const geometry::Vec3 first = grid.in_cells(bounds.min());
  const geometry::Vec3 last = grid.in_cells(bounds.max());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = static_cast<Eigen::Index>(axis);
    if (!(first[i] >= 0.25 && last[i] <= grid.size[axis] - 0.25)) return std::nullopt;
  }
  return grid;
}

std::int32_t CellGrid::longest_side() const { return *std::max_element(size.begin(), size.end()); }

}  // namespace camway::scene
