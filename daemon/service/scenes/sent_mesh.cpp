// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/sent_mesh.h"

#include "lcmtypes/wire/object_mesh.h"

namespace camway::service {
namespace {

/// Adds a mesh whose frame begins at `origin_O`.
void add(const scene::Mesh& mesh, const geometry::Vec3& origin_O, wire::ObjectMesh& sent) {
  const auto first = static_cast<std::uint32_t>(sent.vertices_m.size());
  for (const geometry::Vec3& vertex : mesh.vertices) {
    const geometry::Vec3 at = vertex + origin_O;
    sent.vertices_m.push_back({at.x(), at.y(), at.z()});
  }
  for (const auto& [a, b, c] : mesh.triangles)
    sent.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

std::vector<std::uint8_t> sent_mesh(const scene::SceneObject& object) {
  const scene::ObjectSource& source = *object.source;
  wire::ObjectMesh sent;
  sent.has_inside = source.map_O != nullptr;
  sent.surface_error_m = source.report.surface_error_m;
  for (const scene::MeshPart& part : source.parts_O) add(*part.mesh, source.map_origin_O, sent);
  if (!sent.has_inside) {
    for (const scene::MeshObject& part : source.parts_O.front().mesh->objects)
      sent.parts.push_back({part.name, part.triangle_count});
  } else {
    sent.parts.push_back({{}, static_cast<std::uint32_t>(sent.triangles.size())});
  }
  return wire::encode_mesh(sent);
}

}  // namespace camway::service
