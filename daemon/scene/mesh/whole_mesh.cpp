// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/whole_mesh.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <utility>

namespace camway::scene {
namespace {

/// The name of an object in `mesh`, which belongs to `part`; `is_only` if the scene has no other
/// part.
std::string full_name(const WholeMesh::Part& part, bool is_only, const Mesh& mesh,
                      const MeshObject& object) {
  if (is_only) return object.name;
  const bool has_several = mesh.objects.size() > 1 && !object.name.empty();
  return has_several ? part.name + "/" + object.name : part.name;
}

/// The object that holds `triangle`; null if none does.
const MeshObject* object_of(const Mesh& mesh, std::uint32_t triangle) {
  // The first object that ends behind it. Objects without triangles end where they begin, so they
  // are skipped.
  const auto found = std::ranges::partition_point(mesh.objects, [&](const MeshObject& object) {
    return object.first_triangle + object.triangle_count <= triangle;
  });
  if (found == mesh.objects.end() || found->first_triangle > triangle) return nullptr;
  return &*found;
}

void append(const WholeMesh::Part& part, bool is_only, const Mesh& mesh, Mesh& whole) {
  const auto first_vertex = static_cast<std::uint32_t>(whole.vertices.size());
  const auto first_triangle = static_cast<std::uint32_t>(whole.triangles.size());
  whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    whole.triangles.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]});
  }
  for (const MeshObject& object : mesh.objects) {
    whole.objects.push_back({full_name(part, is_only, mesh, object),
                             first_triangle + object.first_triangle, object.triangle_count});
  }
}

void append(const WholeMesh::Part& part, bool is_only, Mesh& whole) {
  const std::size_t first = whole.objects.size();
  for (const auto& mesh : part.meshes) append(part, is_only, *mesh, whole);
  if (part.meshes.size() < 2) return;
  // An object with several meshes is one object of the whole mesh.
  MeshObject all = whole.objects[first];
  all.triangle_count = static_cast<std::uint32_t>(whole.triangles.size()) - all.first_triangle;
  whole.objects.resize(first);
  whole.objects.push_back(std::move(all));
}

}  // namespace

struct WholeMesh::State {
  std::vector<Part> parts;
  std::once_flag once;
  std::shared_ptr<const Mesh> whole;  ///< set once
  std::once_flag surfaces_once;
  ClosedSurfaces surfaces;  ///< set once
};

WholeMesh::WholeMesh() : WholeMesh(std::make_shared<const Mesh>()) {}

WholeMesh::WholeMesh(std::shared_ptr<const Mesh> mesh)
    : WholeMesh(std::vector<Part>{{"", {std::move(mesh)}}}) {}

WholeMesh::WholeMesh(std::vector<Part> parts) : state_(std::make_shared<State>()) {
  assert(std::ranges::all_of(parts, [](const Part& part) {
    return std::ranges::all_of(part.meshes, [](const auto& mesh) { return mesh != nullptr; });
  }));
  state_->parts = std::move(parts);
}

const std::shared_ptr<const Mesh>& WholeMesh::share() const {
  std::call_once(state_->once, [this] {
    const std::vector<Part>& parts = state_->parts;
    const bool is_only = parts.size() == 1;
    if (is_only && parts.front().meshes.size() == 1) {
      state_->whole = parts.front().meshes.front();
      return;
    }
    Mesh whole;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (const Part& part : parts) {
      for (const auto& mesh : part.meshes) {
        vertices += mesh->vertices.size();
        triangles += mesh->triangles.size();
      }
    }
    whole.vertices.reserve(vertices);
    whole.triangles.reserve(triangles);
    for (const Part& part : parts) append(part, is_only, whole);
    state_->whole = std::make_shared<const Mesh>(std::move(whole));
  });
  return state_->whole;
}

const ClosedSurfaces& WholeMesh::closed_surfaces() const {
  std::call_once(state_->surfaces_once,
                 [this] { state_->surfaces = find_closed_surfaces(*share()); });
  return state_->surfaces;
}

std::string WholeMesh::object_name(std::uint32_t triangle) const {
  for (const Part& part : state_->parts) {
    for (const auto& mesh : part.meshes) {
      if (triangle >= mesh->triangles.size()) {
        triangle -= static_cast<std::uint32_t>(mesh->triangles.size());
        continue;
      }
      const MeshObject* object = object_of(*mesh, triangle);
      if (object == nullptr) return {};
      return full_name(part, state_->parts.size() == 1, *mesh, *object);
    }
  }
  return {};
}

}  // namespace camway::scene
