// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot.h"

namespace camway::planning {

/// Builds the path through the request's keyframes, finds its collisions with the scene, corrects
/// them and checks the result. A pure function: the same arguments give a bit-identical result,
/// timing apart (and unless the deadline strikes). Never throws; safe from any thread.
PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request);

}  // namespace camway::planning
