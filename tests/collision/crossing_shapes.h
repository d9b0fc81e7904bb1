// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/mesh/mesh.h"
#include "tests/collision/precise_pose.h"
#include "tests/support/random.h"

/// Obstacles for the crossing campaign. Points are in extended precision and are rounded to doubles
/// once, when they become vertices.
namespace camway::testing {

/// Returns two unit vectors that are orthogonal to the unit vector `normal` and to each other.
std::array<RealVec3, 2> across(Random& random, const RealVec3& normal);

void add_face(scene::Mesh& mesh, const RealVec3& a, const RealVec3& b, const RealVec3& c);

/// Adds a parallelogram of two triangles, `center ± a ± b`.
void add_plate(scene::Mesh& mesh, const RealVec3& center, const RealVec3& a, const RealVec3& b);

/// Adds a box of 12 triangles, `center ± a ± b ± c`.
void add_slab(scene::Mesh& mesh, const RealVec3& center, const RealVec3& a, const RealVec3& b,
              const RealVec3& c);

/// Adds a prism with three long edges: one from `from` to `to`, the others shifted by `u` and `v`.
void add_prism(scene::Mesh& mesh, const RealVec3& from, const RealVec3& to, const RealVec3& u,
               const RealVec3& v);

}  // namespace camway::testing
