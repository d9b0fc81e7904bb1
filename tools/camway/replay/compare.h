// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/motion/body/body.h"
#include "daemon/planning/result.h"

namespace camway::tools {

/// How two answers to one request differ.
struct Difference {
  /// Largest distance, over dense times, between where the two paths have the eye or a corner of
  /// the body's triangles; so it measures position and orientation at once. Sampled, hence a
  /// lower bound, but 0 exactly when the paths are the same bits. Infinite if one path is empty and
  /// the other is not, and if their time spans differ. [Units: metres]
  double path_m = 0.0;
  /// First thing that differs, in words; empty when every number of the answers (timing apart) has
  /// the same bits.
  std::string what;
};

/// Compares all that the two answers say but timing and message: wording may change between
/// versions.
Difference compare(const planning::PlanResult& recorded, const planning::PlanResult& now,
                   const motion::Body& body);

/// Whether two paths have the same bits in every number.
bool same_bits(const motion::Path& a, const motion::Path& b);

}  // namespace camway::tools
