// SPDX-License-Identifier: MIT
#pragma once

#include <string>

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
  /// Description of the first difference; empty if all numbers except for timing have the same
  /// bits.
  std::string what;
};

/// Compares two answers except for timing, and for the message, whose wording may change between
/// versions.
Difference compare(const planning::PlanResult& recorded, const planning::PlanResult& now,
                   const motion::Body& body);

/// Returns whether two paths have the same bits in every number.
bool same_bits(const motion::Path& a, const motion::Path& b);

}  // namespace camway::tools
