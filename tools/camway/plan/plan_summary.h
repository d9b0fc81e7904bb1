// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/planning/result.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::tools {

/// The outcome of planning for a person: status, message and times in one line, then, indented, a
/// line for each change of the path ("2.31-2.65 s: collides with sofa_04; moved up to 0.12 m"), each
/// keyframe that collides where there are several, where the path was slowed, and the objects that
/// prove that there is no path. No newline ends the text. Witnesses have their names already
/// (`planning::name_witnesses`); `mesh`, if there is one, names the objects of the proof.
std::string plan_summary(const planning::PlanResult& result, const scene::Mesh* mesh);

/// "1 keyframe", "2 keyframes".
std::string plural(std::size_t count, std::string_view noun);

/// How many keyframes were put in.
std::size_t inserted_count(const planning::PlanResult& result);

}  // namespace camway::tools
