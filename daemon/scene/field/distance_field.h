// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "daemon/base/array.h"
#include "daemon/base/result.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/field/cell_grid.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

struct DistanceFieldOptions {
  /// Limit of the finished field; the build takes three times that.
  std::size_t memory_limit_bytes = std::size_t{8} << 20;
  unsigned threads = 0;  ///< 0: one per processor; the field does not depend on it
};

struct DistanceFieldStatistics {
  double resolution_m = 0.0;            ///< side of a cell
  std::array<std::int32_t, 3> cells{};  ///< number of cells along x, y and z
  std::uint64_t memory_bytes = 0;
  double settled_from_m = 0.0;  ///< `DistanceField::kSettlingCells` cells
  double settled_share = 0.0;   ///< share of the cells whose bound is `settled_from_m` or more

  bool operator==(const DistanceFieldStatistics&) const = default;
};

/// A lower bound of the clearance of any point by one look-up: a grid of coarse cells over the
/// scene, each with a bound that holds for all of its points.
///
/// A cell that contains a point of a triangle is marked (`mark_touched_cells`). The bound of a cell
/// is its distance from the nearest marked cell (`distance_transform`), rounded down to one of 256
/// levels, so that it fits a byte. Measured: about one cell less than the true distance. Within the
/// grid no bound exceeds 127 cells.
///
/// Immutable. Thread-safe. Queries allocate nothing.
class DistanceField {
 public:
  /// A cell this far from every marked cell is settled: its bound answers the probes of a body as
  /// large as a cell.
  static constexpr int kSettlingCells = 2;

  /// Least share of settled cells of a field that is kept. Measured: 36 % to 82 % in buildings;
  /// under 5 % only where the scene fills its box. A look-up takes about 10 ns, a query of the
  /// index 1 µs and more: at this share the useless look-ups cost a fifth of what the others save.
  static constexpr double kLeastSettledShare = 0.05;

  /// A scene whose thinnest side is less than this share of its longest always keeps its field:
  /// bodies move beside it, where the bound is the distance from the scene's box.
  static constexpr double kFlatness = 0.1;

  /// Number of cells: kCellsPerTriangle for each triangle, at least kSmallestCells, at most what
  /// the memory limit allows. A cell takes about 9 ns of processor time, so this is 2.3 µs per
  /// triangle and some 75 ms at most; twice as many would make the cells a fifth smaller.
  static constexpr std::size_t kCellsPerTriangle = 256;
  static constexpr std::size_t kSmallestCells = std::size_t{1} << 14;

  /// Limit of `SurfaceExtent::effort` of the marking: kEffort, and kEffortPerTriangle for each
  /// triangle. At about 30 ns per unit it is a quarter of a second for fewer than 10^6 triangles.
  static constexpr double kEffort = 0x1p23;
  static constexpr double kEffortPerTriangle = 2.0;

  /// Builds the finest field of `mesh` within these limits. Returns a reason instead if there are
  /// no triangles, no grid can hold them, or too few cells are settled (as in a scene with more
  /// surface than the effort allows to mark in cells that are small enough). The result depends on
  /// the mesh and the memory limit alone: effort is counted, not timed.
  static base::Result<std::shared_ptr<const DistanceField>> build(
      const Mesh& mesh, const DistanceFieldOptions& options = {});

  /// The field that `build` made in cells of `resolution_m` for a mesh with these bounds, of its
  /// codes. Returns a reason instead if there is no such grid, the codes are not as many as its
  /// cells, or the share is none. Whether the codes are right is not checked.
  static base::Result<std::shared_ptr<const DistanceField>> of_codes(
      const geometry::Box& bounds, double resolution_m, base::Array<std::uint8_t> codes,
      double settled_share);
  /// The level of every cell's bound, x fastest. A level stands for the same share of a cell in all
  /// fields of a build.
  [[nodiscard]] const base::Array<std::uint8_t>& codes() const { return codes_; }

  /// Lower bound of the distance from `point_W` to the nearest triangle, rounding included; 0 where
  /// nothing is known: near the scene, and for a point that is not finite. [Units: metres]
  [[nodiscard]] double clearance_at_least_m(const geometry::Vec3& point_W) const {
    const geometry::Vec3 cell = grid_.in_cells(point_W);
    // False for NaN as well.
    const bool inside = cell.x() >= 0.0 && cell.y() >= 0.0 && cell.z() >= 0.0 &&
                        cell.x() < grid_.size[0] && cell.y() < grid_.size[1] &&
                        cell.z() < grid_.size[2];
    return inside ? level_at(cell) : clearance_outside_m(point_W);
  }

  [[nodiscard]] const DistanceFieldStatistics& statistics() const { return statistics_; }

 private:
  /// `codes` holds the level of every cell's bound.
  DistanceField(const CellGrid& grid, base::Array<std::uint8_t> codes, double settled_share);

  /// The bound of a cell. Requires that `cell` lies in the grid.
  [[nodiscard]] double level_at(const geometry::Vec3& cell) const {
    const auto x = static_cast<std::size_t>(cell.x());
    const auto y = static_cast<std::size_t>(cell.y());
    const auto z = static_cast<std::size_t>(cell.z());
    return level_m_[codes_[z * slice_ + y * row_ + x]];
  }

  [[nodiscard]] double clearance_outside_m(const geometry::Vec3& point_W) const;

  CellGrid grid_;
  std::size_t row_ = 0;    ///< distance in `codes_` from one y to the next
  std::size_t slice_ = 0;  ///< distance in `codes_` from one z to the next
  std::array<double, 256> level_m_{};
  base::Array<std::uint8_t> codes_;
  DistanceFieldStatistics statistics_;
};

}  // namespace camway::scene
