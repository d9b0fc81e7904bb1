// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::tools {

/// Returns the result of planning as text: a line with status, message and times, then indented
/// lines for each correction ("2.31-2.65 s: collides with sofa_04; moved up to 0.12 m"), for the
/// largest shift and its viewing distance, for each keyframe that collides if there are several,
/// for the slowed parts, and for the objects that prove that there is no path. The text has no
/// final newline. Requires named witnesses
/// (`planning::name_witnesses`). `mesh` names the objects of the proof; it may be null.
std::string plan_summary(const planning::PlanResult& result, const scene::Mesh* mesh);

/// Returns a count with its noun: "1 keyframe", "2 keyframes".
std::string plural(std::size_t count, std::string_view noun);

/// Returns the number of inserted keyframes.
std::size_t inserted_count(const planning::PlanResult& result);

}  // namespace camway::tools
