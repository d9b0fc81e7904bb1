// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/motion/path/time_origin.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// The keyframes of a request as planning uses them: with unit quaternions, and with times that
/// count from `origin`, or are derived where the request has none.
struct PreparedKeyframes {
  std::vector<motion::Keyframe> keyframes;
  motion::TimeOrigin origin;
};

/// Requires a valid request.
PreparedKeyframes prepared_keyframes(const PlanRequest& request);

/// Returns the path at the sender's times.
motion::Path to_sent_times(const motion::TimeOrigin& origin, const motion::Path& path);

/// Converts each time of `result` to the sender's. The times of given keyframes become the sender's
/// bit for bit, in `keyframes` and at the ends of segments; segments keep their durations. Ends of
/// collision intervals are rounded outwards, so that all time outside of them stays proved free.
void to_sent_times(const motion::TimeOrigin& origin, PlanResult& result);

/// Returns a time as a text for people: five digits, and at least milliseconds.
std::string time_text(double time_s);

}  // namespace camway::planning
