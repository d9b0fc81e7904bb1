// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "daemon/scene/field/cell_grid.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// The amount of surface of a mesh, which predicts the cost of marking its cells.
struct SurfaceExtent {
  double area_m2 = 0.0;
  double outline_m = 0.0;  ///< sum of the lengths of all edges of all triangles
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

/// Returns the extent of `mesh`, bit-identical for any number of threads.
SurfaceExtent surface_extent(const Mesh& mesh, unsigned threads);

/// Sets to 1 the mark of every cell that is within `reliable_margin_cells` of a point of a triangle
/// along each axis; x runs fastest. Leaves alone cells that are twice `mark_margin_cells` away from
/// all triangles. The marked cells depend on mesh and grid alone. Requires a mesh that lies in the
/// grid as with `CellGrid::around`, and `marks` with a byte for each cell.
///
/// A triangle is cut into slabs of the height of one cell, and these into rows of the width of one
/// cell. The piece in a row is convex, so it touches the cells between its ends. Thus a long run of
/// cells costs no more than one (no test of a box for each cell, as in Akenine-Möller 2001).
void mark_touched_cells(const Mesh& mesh, const CellGrid& grid, unsigned threads,
                        std::span<std::uint8_t> marks);

/// The margin for the rounding of users of the marks: the cell beyond a face is marked, too, if a
/// triangle is closer to that face than this. [Units: cells]
double reliable_margin_cells(const CellGrid& grid);

/// The margin by which slabs, rows and runs are extended: `reliable_margin_cells` and the rounding
/// of marking itself. [Units: cells]
double mark_margin_cells(const CellGrid& grid);

}  // namespace camway::scene
