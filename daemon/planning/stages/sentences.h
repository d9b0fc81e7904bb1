// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/correction/path/correction.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/slowing.h"

/// Messages for people: phrases of `PlanResult::message`.
/// Thread-safe.
namespace camway::planning {

/// "1 collision", "2 collisions".
std::string counted(std::size_t count, std::string_view noun);

/// Three digits of a lower bound, rounded towards 0; "0" if it is not positive.
std::string rounded_down(double value);

/// "3 collisions at first, 12 keyframes inserted, 1 keyframe repaired": numbers that are 0 are left
/// out.
std::string what_was_done(const PlanResult& result);

/// "8 directions to move or turn in, 12 changed paths, 60000 places on a way round, 3000 poses on a
/// way round that turns": the counts that are not 0. Empty if nothing was tried.
std::string effort_text(const correction::Effort& effort);

/// "; tried without success: ..." with the sum over all collisions that were not corrected; empty
/// if nothing was tried.
std::string note_of_effort(const std::vector<correction::Correction>& corrections);

/// "; keyframe 2 seems shut in: ...", with the size of the region that was searched, for the
/// keyframes of which everything reachable was searched, and "; no search found a way out of the
/// place where keyframe 2 is" for the others; empty if there is no keyframe. `is_bounded`: whether
/// bounds are a part of what shuts it in.
std::string note_of_shut_in(const std::vector<correction::ShutIn>& shut_in, bool is_bounded);

/// "; note: ..." about options that the request's method ignores; empty if there are none.
std::string note_of_method(const PlanRequest& request);

/// "; note: ..." about the first given keyframe that is tilted much although the policy keeps the
/// horizon level; empty if there is none. Few senders want that; more often another axis is up in
/// the scene.
std::string note_of_tilt(const PlanRequest& request);

/// Returns the longest side of the body's bounding box. Not 0 for the smallest camera: no length is
/// squared.
double body_size_m(const motion::Body& body);

/// "; note: the body is 0.01 m large, ..." for a body so small that the tolerance cannot tell the
/// openings that it fits through from collisions; else empty.
std::string note_of_tolerance(const PlanRequest& request, const motion::Body& body);

/// "; note: no keyframe lies within the bounds of the scene, ..." if that is so; else empty.
/// Keyframes beyond the scene are fine for a flight around an object. More often the unit or the
/// axes of the file are not what was assumed, and then everything looks free.
std::string note_of_scale(const PlanResult& result, const geometry::Box& scene_W);

/// "; `max_inserted_keyframes` allows 10, ..." for a path with remaining collisions that could not
/// be corrected for that limit; else empty. `needed`: the number of keyframes that all corrections
/// that were found need, if that is known and above the limit.
std::string note_of_keyframe_limit(const PlanRequest& request, const PlanResult& result,
                                   std::optional<std::size_t> needed);

/// "; slowed in part to meet the limits, 1.5 times as long"; empty for a path with the times asked
/// for.
std::string note_of_times(const PlanResult& result, bool slowed_everywhere);

/// "options.limits: the path is free, but too fast from 1 s to 2 s: ..." `origin`: origin of the
/// times of `breach`.
std::string why_too_fast(const PlanRequest& request, const LimitBreach& breach,
                         const motion::TimeOrigin& origin);

/// Returns the fault that a message is about: the first that could not be repaired, if keyframes
/// were to be repaired, else the first. Requires at least one fault.
const KeyframeFault& fault_to_name(const std::vector<KeyframeFault>& faults,
                                   const PlanRequest& request);

/// "the deadline of 0.05 s was reached", for what was cut short by it; "half of the deadline" where
/// the other half is for smaller cameras.
std::string deadline_text(const PlanRequest& request);

/// "keyframes[2]: the near quadrilateral collides with the scene there, by ..." for
/// `fault_to_name`. `timed_out`: the deadline passed before free poses were found. `are_all`: all
/// keyframes were looked at. `surface_error_m`: of the scene, kept beside the clearance.
std::string why_refused(const std::vector<KeyframeFault>& faults, const PlanRequest& request,
                        double surface_error_m, bool timed_out, bool are_all);

/// "no path exists: ..." by this proof; with `may_shrink` for the smallest camera that is allowed.
std::string why_infeasible(const Infeasibility& proof, bool may_shrink);

}  // namespace camway::planning
