// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// A place of a path that corrections leave as it is.
struct FixedPlace {
  std::optional<std::size_t> keyframe;  ///< index in the request, if it is the place of a keyframe
  double time_s = 0.0;                  ///< by the times of the path
  double distance_m = 0.0;              ///< from the scene; no path keeps more there
};

/// Share of the distance at a keyframe from which on a path can hardly keep more than it does.
inline constexpr double kHardlyMore = 0.75;

/// Returns the place that keeps a corrected path from a larger clearance: a given keyframe, if the
/// certified clearance is at least `kHardlyMore` of the distance there; else an instant outside of
/// everything that corrections changed, at which the path is nearest to the scene, up to
/// `collision::kClearanceTolerance`. Nothing if there is no such place, or if the deadline strikes.
/// Requires that `result` has a free path with the times of its corrections, and its certificate.
std::optional<FixedPlace> limiting_place(const collision::Query& query, const PlanResult& result,
                                         const base::Deadline& deadline);

}  // namespace camway::planning
