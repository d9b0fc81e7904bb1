// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/base/deadline.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// Builds the path through the request's keyframes, finds its collisions with the scene, corrects
/// them and checks the result. A pure function without a clock of its own: the same snapshot and
/// request give a bit-identical result, except for timing, unless `deadline_reached` is set. Does
/// not throw: an exception, such as lack of memory, becomes a result with the status
/// `kInternalError`. Reports its progress to the deadline. Ends soon when the deadline is told
/// to stop; the result is then meaningless.
/// Thread-safe.
///
/// With `ok`, `certificate.certified` is set: the search for collisions ran on the final segments
/// exactly as they are returned, and everything that it does not list is free, at every instant and
/// with the rounding of the computation bounded (`collision/probe.h` has the proof,
/// docs/guarantees.md its assumptions).
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request,
                const base::Deadline& deadline);

/// Plans with the request's own deadline, counted from the call.
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request);

}  // namespace camway::planning
