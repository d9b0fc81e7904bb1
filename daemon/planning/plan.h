// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/deadline.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot.h"

namespace camway::planning {

/// Builds the path through the request's keyframes, finds its collisions with the scene, corrects
/// them and checks the result. A pure function without a clock of its own: the same snapshot and
/// request give a bit-identical result, timing apart, unless the deadline strikes. Every outcome is
/// a result; safe from any thread.
///
/// The final check covers every instant, not samples, but its rounding bounds are not yet derived:
/// `ok` says that it found nothing, and `certificate.certified` stays false.
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request,
                const collision::Deadline& deadline);

/// The same with the request's own deadline, counted from now.
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request);

}  // namespace camway::planning
