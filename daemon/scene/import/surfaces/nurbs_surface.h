// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/import/surfaces/faceted_surface.h"

namespace camway::scene::surfaces {

/// A point with its weight: (w x, w y, w z, w).
using WeightedPoint = std::array<double, 4>;

/// A tensor-product B-spline surface; a Bezier patch, bicubic or other, is one with knots at 0 and
/// 1 alone. Its degrees follow from the numbers of knots.
struct NurbsSurface {
  std::size_t u_points = 0;
  std::size_t v_points = 0;
  std::vector<double> u_knots;
  std::vector<double> v_knots;
  std::vector<WeightedPoint> points;  ///< u_points * v_points, u varies fastest
};

/// Limits of one surface.
inline constexpr std::size_t kMostDegree = 24;
inline constexpr std::size_t kMostCells = 1'000'000;

/// Returns what makes the numbers of a surface useless: they do not fit each other, are not finite,
/// knots decrease, or a weight is not positive. Empty if nothing does.
std::string fault_of(const NurbsSurface& surface);

/// Returns the surface as triangles on a grid of parameters, without gaps. Each span of knots is
/// halved in u or v, whichever lessens the error more, until the error is within `tolerance`, or
/// the grid has `kMostCells` cells; `error` is what was reached.
///
/// The bound of a cell: with the cell's control points P in homogeneous coordinates, w its weights
/// and L the bilinear surface of its four corners, N = P - w L is a Bezier surface of one degree
/// more, so that |S - L| <= max |N| / min w by the convex hull property (Farin 2002, "Curves and
/// surfaces for CAGD", section 4.2), and L is within |L00 - L10 - L01 + L11| / 4 of two triangles.
/// This bounds rational surfaces too, where the bounds by second derivatives of Filip, Magedson and
/// Markot 1986, "Surface algorithms using bounds on derivatives", hold for polynomials.
///
/// Fails if the surface has a fault (`fault_of`).
base::Result<FacetedSurface> facets_of(const NurbsSurface& surface, double tolerance);

/// Numbers of cells of a grid.
struct GridSize {
  std::size_t u = 1;
  std::size_t v = 1;
};

/// Facets between points on a grid: row by row, `size.u` + 1 points in each of `size.v` + 1 rows.
struct FacetedGrid {
  FacetedSurface facets;
  GridSize size;
};

/// The same with the size of its grid, and with spans that are divided into `least` parts, powers
/// of two, before any is halved. Surfaces that share an edge share its points if they divide it
/// alike.
base::Result<FacetedGrid> grid_of(const NurbsSurface& surface, double tolerance,
                                  const GridSize& least = {});

}  // namespace camway::scene::surfaces
