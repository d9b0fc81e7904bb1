// SPDX-License-Identifier: MIT
#include "tools/view/here/scene_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "tools/view/facts.h"

namespace camway::view {
namespace {

/// Returns all parts of an object as one mesh in its frame.
std::shared_ptr<const scene::Mesh> mesh_of(const scene::ObjectSource& source) {
  const bool is_in_place = source.map_origin_O.isZero(0.0);
  if (source.parts_O.size() == 1 && is_in_place) return source.parts_O.front().mesh;
  scene::Mesh whole = scene::joined(source.parts_O);
  if (!is_in_place) {
    for (geometry::Vec3& vertex : whole.vertices) vertex += source.map_origin_O;
  }
  return std::make_shared<const scene::Mesh>(std::move(whole));
}

}  // namespace

MeshAnswer object_mesh(const scene::Snapshot& snapshot, std::string_view digest) {
  const auto object = std::ranges::find_if(
      snapshot.objects, [digest](const auto& each) { return each->digest == digest; });
  const auto triangles = static_cast<std::int64_t>(snapshot.index.size());
  if (object == snapshot.objects.end()) {
    return {nullptr, triangles, code::kNotFound,
            fmt::format("the scene '{}' has no object of this digest", snapshot.name)};
  }
  return {mesh_of(*(*object)->source), triangles};
}

std::string MeshDigests::of(const std::shared_ptr<const scene::ObjectSource>& source) {
  if (source->kind == scene::ObjectKind::kMap) return {};
  const std::lock_guard lock(mutex_);
  if (const auto found = kept_.find(source.get()); found != kept_.end()) {
    if (found->second.source.lock() == source) return found->second.digest;
  }
  std::erase_if(kept_, [](const auto& each) { return each.second.source.expired(); });
  std::string digest = scene::mesh_digest(*mesh_of(*source));
  kept_.insert_or_assign(source.get(), Kept{source, digest});
  return digest;
}

Answer scene_triangles(const scene::Snapshot& snapshot, const std::vector<std::int64_t>& indices) {
  const auto size = static_cast<std::int64_t>(snapshot.index.size());
  std::map<std::int64_t, geometry::Triangle> triangles;
  for (const std::int64_t index : indices) {
    if (index < 0 || index >= size) continue;
    triangles.emplace(index, snapshot.index.triangle(static_cast<std::size_t>(index)));
  }
  return {code::kOk, triangles_json(static_cast<std::int64_t>(snapshot.revision), triangles), {}};
}

}  // namespace camway::view
