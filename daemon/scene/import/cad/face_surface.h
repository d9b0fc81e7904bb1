// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>

#include "daemon/base/result.h"
#include "daemon/scene/import/cad/edge_curves.h"
#include "daemon/scene/import/surfaces/edge_refinement.h"

namespace camway::scene::cad {

/// Returns why a surface is no rational B-spline, exactly: it is offset from another, or of a kind
/// that is not known. Empty for all others: planes, cylinders, cones, spheres and tori, surfaces of
/// revolution and of extrusion of conics and B-splines, B-spline and Bezier surfaces (Piegl and
/// Tiller 1997, "The NURBS Book", chapter 8).
std::string fault_of_form(const Handle(Geom_Surface) & surface);

/// A face that the library has made triangles of.
struct FaceMesh {
  surfaces::RefinableFace face;
  double edge_tolerance = 0.0;  ///< how far its trim curves may be from its edges, as it says
  bool is_reversed = false;     ///< whether the outside is where the triangles turn clockwise
};

/// Takes the surface, the triangles and the trim curves of a face whose surface and trim curves are
/// B-splines. `edges` are those of its part. Fails with the reason: "has no triangles".
base::Result<FaceMesh> mesh_of_face(const TopoDS_Face& face, const EdgeCurves& edges);

}  // namespace camway::scene::cad
