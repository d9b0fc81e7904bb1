// SPDX-License-Identifier: MIT
#include "tests/collision/crossing_shapes.h"

namespace camway::testing {

std::array<RealVec3, 2> across(Random& random, const RealVec3& normal) {
  const RealVec3 any = random.direction().cast<Real>();
  const RealVec3 first = normal.cross(any).normalized();
  return {first, normal.cross(first)};
}

void add_face(scene::Mesh& mesh, const RealVec3& a, const RealVec3& b, const RealVec3& c) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const RealVec3& point : {a, b, c}) mesh.vertices.emplace_back(point.cast<double>());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void add_plate(scene::Mesh& mesh, const RealVec3& center, const RealVec3& a, const RealVec3& b) {
  add_face(mesh, center - a - b, center + a - b, center + a + b);
  add_face(mesh, center - a - b, center + a + b, center - a + b);
}

void add_slab(scene::Mesh& mesh, const RealVec3& center, const RealVec3& a, const RealVec3& b,
              const RealVec3& c) {
  for (const Real side : {Real(-1), Real(1)}) {
    add_plate(mesh, center + side * a, b, c);
    add_plate(mesh, center + side * b, c, a);
    add_plate(mesh, center + side * c, a, b);
  }
}

void add_prism(scene::Mesh& mesh, const RealVec3& from, const RealVec3& to, const RealVec3& u,
               const RealVec3& v) {
  const std::array<RealVec3, 3> beside{RealVec3::Zero(), u, v};
  for (std::size_t i = 0; i < 3; ++i) {
    const RealVec3& here = beside[i];
    const RealVec3& next = beside[(i + 1) % 3];
    add_face(mesh, from + here, to + here, to + next);
    add_face(mesh, from + here, to + next, from + next);
  }
}

}  // namespace camway::testing
