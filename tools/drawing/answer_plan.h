// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"
#include "tools/drawing/floor_plan.h"

namespace camway::draw {

/// Returns the plan of an answer: the path through its given keyframes, the corrected path with the
/// ranges that corrections changed, the collisions of both, the barrier, and the answer's message.
/// `up` and `title` remain to be set. Requires a result of planning, whose keyframes can be
/// interpolated.
FloorPlan plan_of_answer(const planning::PlanRequest& request, const planning::PlanResult& result,
                         scene::Mesh mesh);

/// Sets what moves in a plan. Requires a body that `motion::Body::make` accepts; another one is
/// left out.
void set_body(const planning::PlanRequest& request, FloorPlan& plan);

}  // namespace camway::draw
