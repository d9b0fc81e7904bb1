// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/correction/path/correction.h"
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

/// "; keyframe 2 seems shut in: ...", with the size of the region that it was looked at; nothing
/// where none is.
std::string note_of_shut_in(const std::vector<correction::ShutIn>& shut_in);

/// "; note: ..." about options that the request's method does not look at; nothing where there are
/// none.
std::string note_of_method(const PlanRequest& request);

/// "; note: ..." about a given keyframe that is tilted much where the policy keeps the horizon
/// level: fine for who wants it so, but more often another axis is up in the scene.
std::string note_of_tilt(const PlanRequest& request);

/// Of keyframes at fault, the one that a message is about: where they were to be repaired, the
/// first that could not be. Precondition: there are some.
const KeyframeFault& fault_to_name(const std::vector<KeyframeFault>& faults,
                                   const PlanRequest& request);

/// "keyframes[2]: the near quadrilateral collides with the scene there, by ..." for
/// `fault_to_name`. `timed_out`: before free poses were looked for.
std::string why_refused(const std::vector<KeyframeFault>& faults, const PlanRequest& request,
                        bool timed_out);

/// "no path exists: ..." by this proof, which may be for the smallest camera that is allowed.
std::string why_infeasible(const Infeasibility& proof, bool may_shrink);

}  // namespace camway::planning
