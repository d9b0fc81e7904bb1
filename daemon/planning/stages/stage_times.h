// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/base/deadline.h"
#include "daemon/planning/request/request.h"

namespace camway::planning {

/// Times that the stages of a plan take, measured on two slow cores, and the shares of the deadline
/// that follow from them. [Units: seconds]
inline constexpr double kInterpolating_s_per_keyframe = 5e-6;
inline constexpr double kSearching_s_per_piece = 4e-6;
inline constexpr double kMeasuring_s_per_piece = 6e-6;
inline constexpr double kSlowing_s_per_piece = 10e-6;

/// Share of the remaining time for corrections. The stages that follow have to end by the deadline,
/// too.
inline constexpr double kShareOfCorrection = 0.95;

/// Least time for the final check and for retiming, however little of the deadline is left: enough
/// for most paths. [Units: seconds]
inline constexpr double kLeastBudget_s = 0.02;

/// Returns the time of the stages after the final check, for each piece of the path.
inline double rest_s_per_piece(const PlanOptions& options) {
  return kMeasuring_s_per_piece + (options.limits.any() ? kSlowing_s_per_piece : 0.0);
}

/// Returns whether a stage of `seconds` has to be left out. Short ones never are.
inline bool leaves_too_little(const base::Deadline& deadline, double seconds) {
  return seconds > kLeastBudget_s && !deadline.leaves_s(seconds);
}

}  // namespace camway::planning
