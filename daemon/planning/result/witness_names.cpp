// SPDX-License-Identifier: MIT
#include "daemon/planning/result/witness_names.h"

#include <string>
#include <utility>

#include "daemon/collision/obstacles.h"

namespace camway::planning {
namespace {

using collision::CollisionInterval;

std::vector<WitnessNames> names_of(const scene::WholeMesh& mesh, const motion::Body& body,
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

WitnessNames describe_witness(const scene::WholeMesh& mesh, const motion::Body& body,
                              const collision::Witness& witness) {
  using collision::Obstacles;
  const std::string feature = body.feature_name(witness.feature);
  if (!Obstacles::is_side(witness.triangle)) return {mesh.object_name(witness.triangle), feature};
  const std::size_t side = Obstacles::side_of(witness.triangle);
  return {"bounds." + std::string(geometry::Bounds::kSideNames[side]), feature};
}

void name_witnesses(const scene::WholeMesh& mesh, const PlanRequest& request, PlanResult& result) {
  if (result.collisions.empty() && result.remaining_collisions.empty()) return;
  if (!result.collision_names.empty() || !result.remaining_names.empty()) return;
  const auto body = motion::Body::make(body_shape(request));
  if (!body) return;
  result.collision_names = names_of(mesh, *body, result.collisions);
  result.remaining_names = names_of(mesh, *body, result.remaining_collisions);
}

std::vector<NamedCollision> with_names(const std::vector<CollisionInterval>& collisions,
                                       const std::vector<WitnessNames>& names) {
  std::vector<NamedCollision> list;
  list.reserve(collisions.size());
  for (const CollisionInterval& interval : collisions) {
    const std::size_t i = list.size();
    list.push_back({interval, i < names.size() ? names[i] : WitnessNames{}});
  }
  return list;
}

void append(std::vector<NamedCollision> list, std::vector<CollisionInterval>& collisions,
            std::vector<WitnessNames>& names) {
  for (NamedCollision& collision : list) {
    collisions.push_back(std::move(collision.interval));
    names.push_back(std::move(collision.names));
  }
}

}  // namespace camway::planning
