// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_grid.h"

/// Slow, obvious references for the occupancy map, in extended precision (64-bit mantissa), which
/// share no code with what they check.
namespace camway::scene::oracle {

using Real = long double;

/// The exact box of a voxel, grown (or shrunk, if negative) by `margin_m` on all sides.
struct RealBox {
  std::array<Real, 3> min;
  std::array<Real, 3> max;
};
RealBox voxel_box(const Voxel& voxel, double resolution_m, Real margin_m);

/// By clipping the triangle against the six planes, one after the other.
bool touches(const geometry::Triangle& triangle, const RealBox& box);

Real distance_m(const geometry::Vec3& point, const RealBox& box);
Real distance_m(const geometry::Vec3& point, const geometry::Triangle& triangle);

/// Parameter in metres where the ray enters, or negative if it misses.
Real ray_entry_m(const geometry::Vec3& origin, const geometry::Vec3& direction, const RealBox& box);

/// Way of the centre of a ball to where it first touches the box, or negative if it never does. The
/// distance is convex along the way: its least by ternary search, then by bisection.
Real ball_way_m(const geometry::Vec3& from, const geometry::Vec3& to, Real radius_m,
                const RealBox& box);

/// All voxels within `margin` voxels of the bounds of `mesh`.
std::vector<Voxel> voxels_around(const Mesh& mesh, double resolution_m, int margin);

/// A mesh of few triangles whose sizes are log-uniform between a hundredth of a voxel and ten
/// voxels, with vertices often exactly on voxel faces, edges and corners.
Mesh random_mesh(std::mt19937_64& random, double resolution_m, int triangles);

/// Log-uniform in [low, high].
double log_uniform(std::mt19937_64& random, double low, double high);
geometry::Vec3 random_direction(std::mt19937_64& random);

}  // namespace camway::scene::oracle
