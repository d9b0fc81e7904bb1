// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/body/camera.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"
#include "tools/drawing/floor_plan.h"

namespace camway::draw {

/// Returns the plan of an answer: the path through its given keyframes, the corrected path with the
/// ranges that corrections changed, the collisions of both, the barrier, and the answer's message.
/// `up` and `title` remain to be set. Requires a result of planning, whose keyframes can be
/// interpolated.
FloorPlan plan_of_answer(const motion::Camera& camera, const planning::PlanResult& result,
                         scene::Mesh mesh);

}  // namespace camway::draw
