// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/motion/body/body.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::planning {

/// Returns the object and the body feature of `witness`, which was found with `mesh` and `body`.
WitnessNames describe_witness(const scene::WholeMesh& mesh, const motion::Body& body,
                              const collision::Witness& witness);

/// Fills `collision_names` and `remaining_names` of a result of planning `request` in the scene
/// `mesh`, unless one of them is there already. Planning itself works with numbers; call this
/// before the result is passed on.
void name_witnesses(const scene::WholeMesh& mesh, const PlanRequest& request, PlanResult& result);

/// A collision with the names of its witness.
struct NamedCollision {
  collision::CollisionInterval interval;
  WitnessNames names;
};

/// Joins collisions and the names of their witnesses, which may be fewer.
std::vector<NamedCollision> with_names(const std::vector<collision::CollisionInterval>& collisions,
                                       const std::vector<WitnessNames>& names);

/// Appends the collisions of `list` and the names of their witnesses to two lists.
void append(std::vector<NamedCollision> list, std::vector<collision::CollisionInterval>& collisions,
            std::vector<WitnessNames>& names);

}  // namespace camway::planning
