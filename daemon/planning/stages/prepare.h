// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// The body of a request that can be planned, and its path as interpolated.
struct PreparedPlan {
  motion::Body body;
  motion::TimeOrigin origin;                ///< origin of all times until `to_sent_times`
  motion::CubicPath interpolated;           ///< through the given keyframes, repaired ones included
  std::vector<motion::Keyframe> keyframes;  ///< given keyframes, as the answer has them
  std::optional<motion::PathFrame> frame;   ///< frame of the request
};

/// Returns the path of a valid request through these keyframes, which are its own but for repairs.
motion::CubicPath interpolated_path(const PlanRequest& request,
                                    const std::vector<motion::Keyframe>& keyframes,
                                    const motion::TimeOrigin& origin);

/// Checks a request, repairs its keyframes where it asks for that, and interpolates them. Adds the
/// bounds, keyframes, keyframe faults and path to `result`.
///
/// Returns nothing if the request cannot be planned, or the deadline leaves too little time for
/// that; `result` then has the status and message of the answer. Requires the obstacles of
/// `snapshot`.
std::optional<PreparedPlan> prepare(const scene::Snapshot& snapshot,
                                    const collision::Obstacles& obstacles,
                                    const PlanRequest& request, const base::Deadline& deadline,
                                    PlanResult& result);

}  // namespace camway::planning
