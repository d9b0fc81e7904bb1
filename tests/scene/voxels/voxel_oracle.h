// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "tests/support/random.h"

/// Slow and simple oracles for the occupancy map, in extended precision (64-bit mantissa). Share no
/// code with the map.
namespace camway::scene::oracle {

using Real = long double;

/// The exact box of a voxel, grown (or shrunk, if negative) by `margin_m` on all sides.
struct RealBox {
  std::array<Real, 3> min;
  std::array<Real, 3> max;
};
RealBox voxel_box(const Voxel& voxel, double resolution_m, Real margin_m);

/// Returns whether triangle and box touch, by clipping the triangle against the six planes in turn.
bool touches(const geometry::Triangle& triangle, const RealBox& box);

Real distance_m(const geometry::Vec3& point, const RealBox& box);
Real distance_m(const geometry::Vec3& point, const geometry::Triangle& triangle);

/// Returns the distance along the ray to its entry into the box; negative if it misses.
Real ray_entry_m(const geometry::Vec3& origin, const geometry::Vec3& direction, const RealBox& box);

/// Returns the distance that the centre of a ball moves until the ball touches the box; negative if
/// it never does. The distance to the box is convex along the line: a ternary search finds its
/// minimum, then bisection the first contact.
Real ball_way_m(const geometry::Vec3& from, const geometry::Vec3& to, Real radius_m,
                const RealBox& box);

/// Returns all voxels within `margin` voxels of the bounds of `mesh`.
std::vector<Voxel> voxels_around(const Mesh& mesh, double resolution_m, int margin);

/// Returns a mesh of few triangles, with sizes log-uniform between a hundredth of a voxel and ten
/// voxels, and with vertices often exactly on voxel faces, edges and corners.
Mesh random_mesh(testing::Random& random, double resolution_m, int triangles);

}  // namespace camway::scene::oracle
