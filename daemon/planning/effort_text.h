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

/// Three digits of a lower bound, rounded towards 0; "0" if it is not positive.
std::string rounded_down(double value);

/// "8 directions to move or turn in, 12 changed paths, 60000 places on a way round, 3000 poses on a
/// way round that turns": the counts that are not 0. Empty if nothing was tried.
std::string effort_text(const correction::Effort& effort);

/// "; tried without success: ..." over all that was not corrected; nothing where nothing was tried.
std::string note_of_effort(const std::vector<correction::Correction>& corrections);

/// "; note: ..." about options that the request's method does not look at; nothing where there are
/// none.
std::string note_of_method(const PlanRequest& request);

/// "no path exists: ..." by this proof, which may be for the smallest camera that is allowed.
std::string why_infeasible(const Infeasibility& proof, bool may_shrink);

}  // namespace camway::planning
