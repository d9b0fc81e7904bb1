// SPDX-License-Identifier: MIT
#include "daemon/scene/whole_mesh.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <utility>

namespace camway::scene {
namespace {

/// The name of an object of `part`, one of several.
std::string full_name(const WholeMesh::Part& part, const MeshObject& object) {
  const bool has_several = part.mesh->objects.size() > 1 && !object.name.empty();
  return has_several ? part.name + "/" + object.name : part.name;
}

/// The object that holds `triangle`; null if none does.
const MeshObject* object_of(const Mesh& mesh, std::uint32_t triangle) {
  // The first that ends behind it: objects without triangles end where they begin, and are passed.
  const auto found = std::ranges::partition_point(mesh.objects, [&](const MeshObject& object) {
    return object.first_triangle + object.triangle_count <= triangle;
  });
  if (found == mesh.objects.end() || found->first_triangle > triangle) return nullptr;
  return &*found;
}

void append(const WholeMesh::Part& part, Mesh& whole) {
  const auto first_vertex = static_cast<std::uint32_t>(whole.vertices.size());
  const auto first_triangle = static_cast<std::uint32_t>(whole.triangles.size());
  const Mesh& mesh = *part.mesh;
  whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    whole.triangles.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]});
  }
  for (const MeshObject& object : mesh.objects) {
    whole.objects.push_back(
        {full_name(part, object), first_triangle + object.first_triangle, object.triangle_count});
  }
}

}  // namespace

struct WholeMesh::State {
  std::vector<Part> parts;
  std::once_flag once;
  std::shared_ptr<const Mesh> whole;  ///< set once
};

WholeMesh::WholeMesh() : WholeMesh(std::make_shared<const Mesh>()) {}

WholeMesh::WholeMesh(std::shared_ptr<const Mesh> mesh)
    : WholeMesh(std::vector<Part>{{"", std::move(mesh)}}) {}

WholeMesh::WholeMesh(std::vector<Part> parts) : state_(std::make_shared<State>()) {
  assert(std::ranges::all_of(parts, [](const Part& part) { return part.mesh != nullptr; }));
  state_->parts = std::move(parts);
}

const std::shared_ptr<const Mesh>& WholeMesh::share() const {
  std::call_once(state_->once, [this] {
    if (state_->parts.size() == 1) {
      state_->whole = state_->parts.front().mesh;
      return;
    }
    Mesh whole;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (const Part& part : state_->parts) {
      vertices += part.mesh->vertices.size();
      triangles += part.mesh->triangles.size();
    }
    whole.vertices.reserve(vertices);
    whole.triangles.reserve(triangles);
    for (const Part& part : state_->parts) append(part, whole);
    state_->whole = std::make_shared<const Mesh>(std::move(whole));
  });
  return state_->whole;
}

std::string WholeMesh::object_name(std::uint32_t triangle) const {
  for (const Part& part : state_->parts) {
    if (triangle >= part.mesh->triangles.size()) {
      triangle -= static_cast<std::uint32_t>(part.mesh->triangles.size());
      continue;
    }
    const MeshObject* object = object_of(*part.mesh, triangle);
    if (object == nullptr) return {};
    return state_->parts.size() == 1 ? object->name : full_name(part, *object);
  }
  return {};
}

}  // namespace camway::scene
