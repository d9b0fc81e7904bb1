// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/motion/path/time_origin.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

namespace camway::planning {

/// The keyframes of a request as planning uses them: unit quaternions, times counted from an
/// origin, derived where none were given.
struct PreparedKeyframes {
  std::vector<motion::Keyframe> keyframes;
  motion::TimeOrigin origin;
};

/// Precondition: the request is valid.
PreparedKeyframes prepared_keyframes(const PlanRequest& request);

/// Turns each time of `result` into the sender's. The times of given keyframes become the sender's
/// bit for bit, in `keyframes` and at the ends of segments; segments keep their durations. Ends of
/// collision intervals are rounded outwards, so what is outside of them stays proved free.
void to_sent_times(const motion::TimeOrigin& origin, PlanResult& result);

/// A time for a person: five digits, and at least milliseconds.
std::string time_text(double time_s);

}  // namespace camway::planning
