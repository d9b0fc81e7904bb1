// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/base/deadline.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// Builds the path through the request's keyframes, finds its collisions with the scene, corrects
/// them and checks the result. A pure function without a clock of its own: the same snapshot and
/// request give a bit-identical result, timing apart, unless the deadline strikes, which
/// `deadline_reached` says. Every outcome is a result; safe from any thread. It tells the deadline
/// how far it is; told to stop, it ends soon, with a result that is worth nothing.
///
/// `ok` and `certificate.certified` go together: the search for collisions ran on the final
/// segments exactly as they are returned, and everything it does not list is free, at every instant
/// and with the rounding of the computation bounded (`collision/probe.h` has the proof,
/// ARCHITECTURE.md its assumptions).
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request,
                const collision::Deadline& deadline);

/// The same with the request's own deadline, counted from now.
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request);

}  // namespace camway::planning
