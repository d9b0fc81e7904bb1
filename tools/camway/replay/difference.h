// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/plan_response_t.hpp>

#include "daemon/motion/body/body.h"
#include "daemon/planning/result/result.h"

namespace camway::tools {

/// The difference of two answers to one request.
struct Difference {
  /// Largest distance between the two paths' positions of the eye, or of a corner of the body's
  /// triangles, at densely sampled times. It covers position and orientation. Sampling makes it a
  /// lower bound, but it is 0 exactly if the paths have the same bits. Infinite if only one path is
  /// empty or if the time spans differ. [Units: metres]
  double path_m = 0.0;
  /// The first member that differs, by its name in files: "corrections[1].moved_m", "segments 3 ->
  /// 4", "status ok -> partial". Empty if all members have the same bits.
  std::string what;
};

/// Compares a recorded answer with a new one, member by member as messages have them, but for what
/// tells how they were found: times, effort, whether the deadline was reached, and the message,
/// whose wording may change between versions.
Difference difference_of(const plan_response_t& recorded, const planning::PlanResult& now,
                         const motion::Body& body);

}  // namespace camway::tools
