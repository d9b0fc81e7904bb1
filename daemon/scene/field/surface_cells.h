// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "daemon/scene/field/cell_grid.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// How much surface a mesh has, for foretelling what going over its cells costs.
struct SurfaceExtent {
  double area_m2 = 0.0;
  double outline_m = 0.0;  ///< lengths of all edges of all triangles
  double triangles = 0.0;

  /// `mark_touched_cells` looks at no more than kCellsPerEffort times this many cells.
  [[nodiscard]] double effort(double resolution_m) const {
    return area_m2 / (resolution_m * resolution_m) + outline_m / resolution_m + triangles;
  }

  /// Cells of side 1 that a triangle touches lie within √3 of it. The volume within ρ of a flat
  /// convex set is 2ρ·area + π/2·ρ²·outline + 4/3·π·ρ³ (Steiner's formula): at ρ = √3 the factors
  /// are 3.5, 4.8 and 21.8.
  static constexpr double kCellsPerEffort = 22.0;
};

/// Bit-identical for any number of threads.
SurfaceExtent surface_extent(const Mesh& mesh, unsigned threads);

/// Sets to 1 the mark of every cell that is within `reliable_margin_cells` of a point of a triangle
/// along each axis; x runs fastest. A cell that is twice `mark_margin_cells` away from all of them
/// is left alone. Which cells are marked depends on mesh and grid alone. Preconditions: the mesh
/// lies in the grid as `CellGrid::around` has it; `marks` has a byte for each cell.
///
/// A triangle is cut into slabs of one cell's height, these into rows of one cell's width, and what
/// is left is convex: the cells that it touches are those between its ends. So a long run of cells
/// costs no more than one (no test of a box for each, as in Akenine-Möller 2001).
void mark_touched_cells(const Mesh& mesh, const CellGrid& grid, unsigned threads,
                        std::span<std::uint8_t> marks);

/// What marking leaves to its users for their own rounding: whatever is closer than this to the
/// face of a cell has marked the cell beyond as well. [Units: cells]
double reliable_margin_cells(const CellGrid& grid);

/// How far slabs, rows and runs are extended for that, the rounding of marking itself included.
/// [Units: cells]
double mark_margin_cells(const CellGrid& grid);

}  // namespace camway::scene
