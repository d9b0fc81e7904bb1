// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/correction/correction.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

namespace camway::planning {

/// "1 collision", "2 collisions".
std::string counted(std::size_t count, std::string_view noun);

/// "8 directions to move or turn in, 12 changed paths, 60000 lattice points, 3000 tree samples":
/// what of that there was. Empty if nothing was tried.
std::string effort_text(const correction::Effort& effort);

/// "; tried without success: ..." over all that was not corrected; nothing where nothing was tried.
std::string note_of_effort(const std::vector<correction::Correction>& corrections);

/// "; note: ..." about options that the request's method does not look at; nothing where there are
/// none.
std::string note_of_method(const PlanRequest& request);

/// "; note: ..." about a given keyframe that is tilted much where the policy keeps the horizon
/// level: fine for who wants it so, but more often another axis is up in the scene.
std::string note_of_tilt(const PlanRequest& request);

/// "there is no path: ..." by this proof, which may be for the smallest camera that is allowed.
std::string why_infeasible(const Infeasibility& proof, bool may_shrink);

}  // namespace camway::planning
