// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/import/surfaces/faceted_surface.h"

/// Spheres, cylinders and cones as Open Inventor and VRML define them: around the origin, with the
/// axis along y. Their outlines have no gaps: facets that meet share their points. Triangles turn
/// counter-clockwise as seen from outside. All sizes must be finite; a negative one mirrors.
namespace camway::scene::surfaces {

struct CylinderParts {
  bool side = true;
  bool top = true;
  bool bottom = true;
};

/// A sphere by subdividing an icosahedron, within `kRelativeTolerance` of the radius.
FacetedSurface sphere(double radius);
/// A prism on a regular polygon, within `kRelativeTolerance` of the radius.
FacetedSurface cylinder(double radius, double height, const CylinderParts& parts);
/// A pyramid with its apex at +height / 2; `top` of the parts has no meaning.
FacetedSurface cone(double bottom_radius, double height, const CylinderParts& parts);

}  // namespace camway::scene::surfaces
