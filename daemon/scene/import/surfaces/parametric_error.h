// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/import/surfaces/nurbs_surface.h"

namespace camway::scene::surfaces {

/// (u, v).
using Parameters = std::array<double, 2>;

/// A surface that may repeat itself; a period of 0 says that it does not. The knots of a direction
/// with a period cover one.
struct ParametricSurface {
  NurbsSurface surface;
  Parameters periods{};
};

/// The part of a trim curve between two neighbouring nodes of the boundary, along which the face is
/// on the left in (u, v). The curve is in the convex hull of `hull` and the nodes.
struct TrimPiece {
  std::array<std::uint32_t, 2> nodes{};
  std::vector<Parameters> hull;
};

/// The triangles that another program made of a face: of a surface within trim curves.
struct ParametricMesh {
  std::vector<Parameters> parameters;  ///< of each node
  std::vector<Point> points;           ///< where each node is, which may be beside the surface
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise in (u, v)
  std::vector<TrimPiece> boundary;
};

/// Returns whether a triangle turns over in (u, v), by more than its area may be rounded.
bool has_turned(const std::array<Parameters, 3>& triangle);

/// Returns a bound of the distance in space between a trim curve and its chord: s of `error_of`.
/// Requires a surface without a fault (`fault_of`).
double sag_of(const ParametricSurface& surface, const ParametricMesh& mesh, const TrimPiece& piece);

/// Returns a bound of the distance of any point of the face from the triangles, and of any point of
/// the triangles from the face. Nothing is assumed of how the triangles were made.
///
/// *A triangle* T with nodes P_j and parameters v_j: a point of it is x = sum l_j P_j, and it
/// stands for S(w) with w = sum l_j v_j. Both S and x are smooth along w, x is linear, so that by
/// Taylor's formula from w to each v_j, weighted with l_j,
///
///     |S(w) - x| <= max_j |S(v_j) - P_j| + 1/8 (M_uu a^2 + 2 M_uv a b + M_vv b^2)
///
/// where a and b are the extents of the triangle in u and v, as sum l_j (v_j - w)^2 is at most a^2
/// / 4, and M_.. bound the second derivatives over the rectangle around it (Filip, Magedson and
/// Markot 1986, "Surface algorithms using bounds on derivatives", for right triangles and
/// polynomials). Triangles are cut where they cross a knot, since S need not be smooth there, and
/// then into four while that lessens the bound: S - x is known at the corners of the parts. Thin
/// triangles do no harm, unlike in a bound of S less the linear map (u, v) -> x over a rectangle.
///
/// *Derivatives.* A linear map L has no second derivatives, so those of S are those of R = S - L,
/// with L through three corners of the rectangle, which makes R and its first derivatives small. R
/// = N / w with Bezier polynomials N and w over the rectangle, whose derivatives are in the convex
/// hulls of differences of control points (Farin 2002, "Curves and surfaces for CAGD", sections 4.2
/// and 14.6). R w = N gives
///
///     |R_u| <= (|N_u| + |w_u| |R|) / min w
///     |R_uu| <= (|N_uu| + 2 |w_u| |R_u| + |w_uu| |R|) / min w
///     |R_uv| <= (|N_uv| + |w_u| |R_v| + |w_v| |R_u| + |w_uv| |R|) / min w
///
/// (Piegl and Tiller 1997, "The NURBS Book", section 4.5, with |.| for each term).
///
/// *The boundary.* Let D be the region within the trim curves, and C that within their chords. It
/// is checked that the triangles do not turn over, and that their outline is the chords; so they
/// cover C by winding numbers, each point as often as C winds around it. A point w of one region
/// and not of the other has a winding number other than 0 for the loop of some chord and its curve:
/// their sum is the difference. So w is in the hull of that curve, whose distance from the chord,
/// in the norm |M_u du| + |M_v dv|, is convex and largest at a control point: s. In D, but not in
/// C: S(w) is within s of S at the chord, and so within s + e of a triangle. In C, but not in D: a
/// ray from w, away from the chord, leaves the loop through the curve, no further away than s; so x
/// is within e + s of S there. The bound is the largest e plus the largest s.
///
/// Fails if the triangles are not the region within the chords, or the surface has a fault
/// (`fault_of`). Requires indices of nodes that exist.
base::Result<double> error_of(const ParametricSurface& surface, const ParametricMesh& mesh);

}  // namespace camway::scene::surfaces
