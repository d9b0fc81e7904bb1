// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/planning/result.h"
#include "daemon/scene/mesh.h"

namespace camway::tools {

/// What came of planning, for a person: a line that says it all, then, indented, a line for each
/// correction ("2.31-2.65 s: moved 0.12 m (edge 2 met sofa_04)"), each keyframe at fault, what was
/// scaled, and the surface that proves that there is no path. No line ends the text. Witnesses have
/// their names already (`planning::name_witnesses`); `mesh`, if there is one, names the objects of
/// the proof.
std::string plan_summary(const planning::PlanResult& result, const scene::Mesh* mesh);

/// "1 keyframe", "2 keyframes".
std::string plural(std::size_t count, std::string_view noun);

/// How many keyframes were put in.
std::size_t inserted_count(const planning::PlanResult& result);

}  // namespace camway::tools
