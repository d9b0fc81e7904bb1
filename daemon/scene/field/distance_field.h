// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/field/cell_grid.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

struct DistanceFieldOptions {
  /// What the finished field may take; while it is built it takes three times that.
  std::size_t memory_limit_bytes = std::size_t{8} << 20;
  unsigned threads = 0;  ///< 0: one a processor. The field does not depend on it
};

struct DistanceFieldStatistics {
  double resolution_m = 0.0;            ///< side of a cell
  std::array<std::int32_t, 3> cells{};  ///< along x, y and z
  std::uint64_t memory_bytes = 0;
  double settled_from_m = 0.0;  ///< `DistanceField::kSettlingCells` cells
  double settled_share = 0.0;   ///< of the cells: their bound is `settled_from_m` or more

  bool operator==(const DistanceFieldStatistics&) const = default;
};

struct DistanceFieldResult;

/// A lower bound of the clearance of any point, in one look-up: a grid of coarse cells over the
/// scene, each with a bound that holds for all of its points.
///
/// A cell that holds a point of a triangle is marked (`mark_touched_cells`); the bound of a cell is
/// the distance between it and the nearest marked cell (`distance_transform`), rounded down to one
/// of 256 levels, so that it fits a byte. Measured: about one cell less than the true distance. No
/// bound is more than 127 cells.
///
/// Immutable; queries are const, allocate nothing and are safe from any thread.
class DistanceField {
 public:
  /// A cell that is this far from every marked cell settles what a body of its size asks there.
  static constexpr int kSettlingCells = 2;

  /// Below this share of settled cells there is no field. Measured: 36 % to 82 % in buildings;
  /// under 5 % only where the scene fills its box. A look-up takes about 10 ns, asking the index
  /// 1 µs and more: at this share the look-ups in vain cost a fifth of what the others save.
  static constexpr double kLeastSettledShare = 0.05;

  /// But a scene whose thinnest side is less than this share of its longest always has one: what
  /// moves there is beside it, where the bound is the distance from the scene's box.
  static constexpr double kFlatness = 0.1;

  /// How many cells there may be: so many for each triangle, but this many in any case, and no more
  /// than the memory allows. A cell takes about 9 ns of processor time, so this is 2.3 µs a
  /// triangle, and some 75 ms at the most; twice as many would make the cells a fifth smaller.
  static constexpr std::size_t kCellsPerTriangle = 256;
  static constexpr std::size_t kSmallestCells = std::size_t{1} << 14;

  /// And how much `SurfaceExtent::effort` marking may take: this, and so much for each triangle. At
  /// about 30 ns that is a quarter of a second for scenes below 10^6 triangles.
  static constexpr double kEffort = 0x1p23;
  static constexpr double kEffortPerTriangle = 2.0;

  /// The finest field of `mesh` within these limits, or why there is none: no triangles, nothing
  /// that a grid could hold, or too few cells that are away from the scene (as in a scene with more
  /// surface than the effort allows to mark in cells that are small enough). The result depends on
  /// the mesh and the limit of memory alone: effort is counted, not timed.
  static DistanceFieldResult build(const Mesh& mesh, const DistanceFieldOptions& options = {});

  /// Never more than the distance from `point_W` to the nearest triangle, rounding included; 0
  /// where nothing is known, so near the scene and for a point that is not finite. [Units: metres]
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
  /// `codes`: for every cell the level of its bound.
  DistanceField(const CellGrid& grid, std::vector<std::uint8_t> codes, double settled_share);

  /// Precondition: `cell` lies in the grid.
  [[nodiscard]] double level_at(const geometry::Vec3& cell) const {
    const auto x = static_cast<std::size_t>(cell.x());
    const auto y = static_cast<std::size_t>(cell.y());
    const auto z = static_cast<std::size_t>(cell.z());
    return level_m_[codes_[z * slice_ + y * row_ + x]];
  }

  [[nodiscard]] double clearance_outside_m(const geometry::Vec3& point_W) const;

  CellGrid grid_;
  std::size_t row_ = 0;    ///< cells from one y to the next
  std::size_t slice_ = 0;  ///< cells from one z to the next
  std::array<double, 256> level_m_{};
  std::vector<std::uint8_t> codes_;
  DistanceFieldStatistics statistics_;
};

/// Either a field or a reason.
struct DistanceFieldResult {
  std::shared_ptr<const DistanceField> field;
  std::string why_off;  ///< empty exactly when `field` is set
};

}  // namespace camway::scene
