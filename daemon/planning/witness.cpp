// SPDX-License-Identifier: MIT
#include "daemon/planning/witness.h"

#include <algorithm>

namespace camway::planning {
namespace {

using collision::CollisionInterval;

/// The object that holds `triangle`; null if none does.
const scene::MeshObject* object_of(const scene::Mesh& mesh, std::uint32_t triangle) {
  // The first that ends behind it: objects without triangles end where they begin, and are passed.
  const auto found =
      std::ranges::partition_point(mesh.objects, [&](const scene::MeshObject& object) {
        return object.first_triangle + object.triangle_count <= triangle;
      });
  if (found == mesh.objects.end() || found->first_triangle > triangle) return nullptr;
  return &*found;
}

std::vector<WitnessNames> names_of(const scene::Mesh& mesh, const motion::Body& body,
                                   const std::vector<CollisionInterval>& intervals) {
  std::vector<WitnessNames> names;
  names.reserve(intervals.size());
  for (const CollisionInterval& interval : intervals) {
    names.push_back(interval.witness ? describe_witness(mesh, body, *interval.witness)
                                     : WitnessNames{});
  }
  return names;
}

}  // namespace

WitnessNames describe_witness(const scene::Mesh& mesh, const motion::Body& body,
                              const collision::Witness& witness) {
  const scene::MeshObject* object = object_of(mesh, witness.triangle);
  return {object != nullptr ? object->name : std::string(), body.feature_name(witness.feature)};
}

void name_witnesses(const scene::Mesh& mesh, const PlanRequest& request, PlanResult& result) {
  if (result.collisions.empty() && result.remaining_collisions.empty()) return;
  if (!result.collision_names.empty() || !result.remaining_names.empty()) return;
  std::string fault;
  const auto body = motion::Body::make(request.body.value_or(request.camera), fault);
  if (!body) return;
  result.collision_names = names_of(mesh, *body, result.collisions);
  result.remaining_names = names_of(mesh, *body, result.remaining_collisions);
}

}  // namespace camway::planning
