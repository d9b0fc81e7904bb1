// SPDX-License-Identifier: MIT
#pragma once

namespace camway::messages {

/// Limits of the time that a request may take from its receipt to the end of planning.
struct DeadlineLimits {
  double default_s = 10.0;  ///< if the request's is 0 [Limit: 0 < value] [Units: seconds]
  double max_s = 60.0;      ///< longer deadlines are cut to this [Limit: default_s <= value]
};

/// Returns the deadline, in seconds, for a request whose deadline is `wire_s`. Only an exact 0 asks
/// for the default: NaN and negative values stay, for `planning::validate`.
inline double deadline_of(double wire_s, const DeadlineLimits& limits) {
  const double deadline_s = wire_s == 0.0 ? limits.default_s : wire_s;
  return deadline_s > limits.max_s ? limits.max_s : deadline_s;
}

}  // namespace camway::messages
