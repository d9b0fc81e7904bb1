// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/prepare.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// The path of a plan after its correction, beside `PlanResult::path`.
struct CorrectedPlan {
  /// The path as corrected by the ladder; nothing if it is as interpolated, or has inserted
  /// keyframes of the paper's method.
  std::optional<motion::CubicPath> path;
  correction::Closeness closeness = {};  ///< with `path`: the scale by which it is near
  bool is_as_interpolated = true;
  bool timed_out = false;  ///< the deadline came before all collisions were corrected
  /// Whether the path is better by another objective than `kClosest` than the closest path.
  bool is_polished = false;
  /// The number of inserted keyframes that all corrections found would need, if that is more than
  /// allowed.
  std::optional<std::size_t> needed_keyframes;
};

/// Corrects `result.collisions`, which are those of the path as interpolated, by the method that
/// the request asks for. Adds path, inserted keyframes, corrections and proofs to `result`.
CorrectedPlan correct(const scene::Snapshot& snapshot, const collision::Query& query,
                      const PlanRequest& request, const PreparedPlan& prepared,
                      const base::Deadline& deadline, PlanResult& result);

/// Restores the path as interpolated, whose collisions are known, from `from_s` on.
void put_back(double from_s, const PlanRequest& request, const PreparedPlan& prepared,
              CorrectedPlan& corrected, PlanResult& result);

}  // namespace camway::planning
