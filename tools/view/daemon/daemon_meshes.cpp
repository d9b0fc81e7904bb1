// SPDX-License-Identifier: MIT
#include "tools/view/daemon/daemon_meshes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tools/view/daemon/daemon_scenes.h"

namespace camway::view {
namespace {

/// Memory of the objects that are kept.
constexpr std::uint64_t kMostKeptBytes = std::uint64_t{512} << 20;

/// Objects whose descriptions are remembered; beyond that many, all are forgotten.
constexpr std::size_t kMostDescribed = 100'000;

/// The number of times that a scene is listed again because it changed meanwhile.
constexpr int kMostListings = 4;

scene::Mesh mesh_of(const SceneTriangles& sent) {
  scene::Mesh mesh;
  mesh.vertices.reserve(sent.vertices_m.size());
  for (const auto& [x, y, z] : sent.vertices_m) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = sent.triangles;
  std::uint32_t first = 0;
  for (const SceneTriangles::Part& part : sent.parts) {
    mesh.objects.push_back({part.name, first, part.num_triangles});
    first += part.num_triangles;
  }
  return mesh;
}

/// Without a distance field, which is large: a proof without it has another bound of the clearance.
scene::ObjectOptions options_of(const SceneInfo& scene) {
  scene::ObjectOptions options;
  options.field.reset();
  options.bounds = geometry::bounds_of({scene.body_bounds.min_m, scene.body_bounds.max_m});
  return options;
}

scene::Placement placement_of(const Pose& pose) {
  const auto& [x, y, z] = pose.position_m;
  const auto& wxyz = pose.orientation_wxyz;
  const geometry::Quat turn = geometry::from_wxyz({wxyz[0], wxyz[1], wxyz[2], wxyz[3]});
  if (geometry::Vec3(x, y, z).isZero(0.0) && turn.coeffs() == geometry::Quat::Identity().coeffs())
    return {};
  return scene::Placement::of_unit({x, y, z}, turn);
}

/// Triangles in the world and a pose have one mesh in the frame of the object.
std::string name_of_mesh(const SceneObject& object) {
  const auto& [position, turn] = object.pose;
  return scene::text_digest({object.digest, fmt::format("{}", fmt::join(position, " ")),
                             fmt::format("{}", fmt::join(turn, " "))});
}

RebuiltScene failed_scene(int code, std::string error) {
  return {nullptr, false, code, std::move(error)};
}

}  // namespace

DaemonMeshes::Fetched DaemonMeshes::find(const std::string& digest) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(kept_, [&](const Kept& kept) { return kept.has(digest); });
  if (found == kept_.end()) return {};
  kept_.splice(kept_.begin(), kept_, found);
  return found->object;
}

void DaemonMeshes::keep(const std::string& digest, const Fetched& object) {
  const std::lock_guard lock(mutex_);
  if (std::ranges::find(kept_, digest, &Kept::digest) != kept_.end()) return;
  kept_.push_front({digest, {}, object});
  bytes_ += object.source->memory_bytes();
  while (bytes_ > kMostKeptBytes && !kept_.empty()) {
    bytes_ -= kept_.back().object.source->memory_bytes();
    kept_.pop_back();
  }
}

void DaemonMeshes::rename(const std::string& digest_before, const std::string& digest) {
  const std::lock_guard lock(mutex_);
  for (Kept& kept : kept_) {
    if (!kept.has(digest_before) || kept.digest == digest) continue;
    kept.digest_before = std::exchange(kept.digest, digest);
    return;
  }
}

bool DaemonMeshes::is_moved(const std::string& digest_before, const SceneInfo& scene,
                            const SceneObject& object) {
  const Fetched known = find(digest_before);
  if (!known.source || known.has_inside) return false;
  const auto triangles = known.source->parts_O.front().mesh->triangles.size();
  if (static_cast<std::int64_t>(triangles) != object.num_triangles) return false;
  const scene::ObjectResult placed =
      scene::place_object(object.name, known.source, placement_of(object.pose), options_of(scene));
  if (!placed.object || placed.object->digest != object.digest) return false;
  rename(digest_before, object.digest);
  return true;
}

std::string DaemonMeshes::mesh_digest(const SceneInfo& scene, const SceneObject& object) {
  if (object.kind == scene::to_string(scene::ObjectKind::kMap)) return {};
  const std::pair key(scene.name, object.name);
  Described before;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = described_.find(key); found != described_.end()) before = found->second;
  }
  const bool is_same = before.digest == object.digest &&
                       before.pose.position_m == object.pose.position_m &&
                       before.pose.orientation_wxyz == object.pose.orientation_wxyz;
  if (is_same) return before.mesh_digest;
  Described now{object.digest, object.pose, {}};
  now.mesh_digest =
      is_moved(before.digest, scene, object) ? before.mesh_digest : name_of_mesh(object);
  const std::lock_guard lock(mutex_);
  if (described_.size() >= kMostDescribed) described_.clear();
  described_.insert_or_assign(key, now);
  return now.mesh_digest;
}

DaemonMeshes::Fetched DaemonMeshes::fetch(const std::string& scene, const std::string& digest) {
  if (Fetched known = find(digest); known.source) return known;
  const SceneTriangles sent = client_.object_triangles(scene, digest);
  if (!sent.ok()) return {nullptr, false, 0, sent.status, sent.error};
  scene::Mesh mesh = mesh_of(sent);
  scene::ImportReport report = scene::report_of(mesh, "daemon");
  report.surface_error_m = sent.surface_error_m;
  Fetched object;
  object.source = scene::make_source(scene::ObjectKind::kMesh, std::move(mesh), std::move(report),
                                     options_of(sent.scene));
  object.has_inside = sent.has_inside;
  object.scene_triangles = sent.scene.num_triangles;
  keep(digest, object);
  return object;
}

MeshAnswer DaemonMeshes::mesh(const std::string& scene, const std::string& digest) {
  const Fetched object = fetch(scene, digest);
  if (object.source) return {object.source->parts_O.front().mesh, object.scene_triangles};
  const bool is_missing = object.status == Status::kInvalid;
  return {nullptr, 0, is_missing ? code::kNotFound : code_of(object.status), object.error};
}

RebuiltScene DaemonMeshes::rebuild(const SceneAnswer& described, bool& is_outdated) {
  RebuiltScene made;
  const scene::ObjectOptions options = options_of(described.scene);
  scene::SceneObjects objects;
  for (const SceneObject& each : described.objects) {
    const Fetched object = fetch(described.scene.name, each.digest);
    is_outdated = object.status == Status::kInvalid;
    if (!object.source) return failed_scene(code_of(object.status), object.error);
    scene::ObjectResult placed =
        scene::place_object(each.name, object.source, placement_of(each.pose), options);
    if (!placed.object) return failed_scene(code::kOurFault, placed.error);
    made.lacks_inside = made.lacks_inside || object.has_inside;
    if (!object.has_inside && placed.object->digest != each.digest) {
      return failed_scene(
          code::kOurFault,
          fmt::format("the triangles of '{}' are not those of its digest", each.name));
    }
    objects.push_back(std::move(placed.object));
  }
  made.snapshot =
      scene::assemble(described.scene.name, static_cast<std::uint64_t>(described.scene.revision),
                      std::move(objects), options);
  return made;
}

RebuiltScene DaemonMeshes::rebuilt(const std::string& scene) {
  RebuiltScene made;
  for (int listing = 0; listing < kMostListings; ++listing) {
    const SceneAnswer described = client_.describe_scene(scene);
    if (!described.ok()) return failed_scene(code_of(described.status), described.error);
    {
      const std::lock_guard lock(mutex_);
      const bool is_last =
          last_.snapshot && last_.snapshot->name == scene &&
          last_.snapshot->revision == static_cast<std::uint64_t>(described.scene.revision) &&
          (last_.lacks_inside || last_.snapshot->digest == described.scene.digest);
      if (is_last) return last_;
    }
    bool is_outdated = false;
    made = rebuild(described, is_outdated);
    if (made.snapshot) {
      const std::lock_guard lock(mutex_);
      last_ = made;
    }
    if (!is_outdated) break;
  }
  return made;
}

std::shared_ptr<const scene::Mesh> DaemonMeshes::known(const std::string& scene_digest) const {
  RebuiltScene last;
  {
    const std::lock_guard lock(mutex_);
    last = last_;
  }
  if (!last.snapshot || last.snapshot->digest != scene_digest) return nullptr;
  return last.snapshot->mesh.share();
}

}  // namespace camway::view
