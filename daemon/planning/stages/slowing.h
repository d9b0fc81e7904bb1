// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/path_check.h"

namespace camway::planning {

/// The part of a path that exceeds its motion limits most. It is found by samples, for a message to
/// people.
struct LimitBreach {
  double t_begin_s = 0.0;  ///< begin of the part
  double t_end_s = 0.0;    ///< end of the part
  std::size_t parts = 1;   ///< number of parts that exceed the limits, this one included
  std::string rate;        ///< e.g. "its speed is up to 1.4 m/s, of 1 m/s that are allowed"
};

/// Returns true only if the path is shown to meet the limits at every instant (`motion::meets`).
/// Rates may exceed their limits by a millionth, accelerations by two.
bool meets_limits(const motion::Path& path, const motion::RateLimits& limits);

/// Returns the part of `path` that exceeds `limits` most, or nothing if `meets_limits` is true.
std::optional<LimitBreach> find_limit_breach(const motion::Path& path,
                                             const motion::RateLimits& limits);

/// A path that is too fast, and what it must keep when it is slowed.
struct TooFast {
  const motion::CubicPath& path;
  const motion::CubicPath& interpolated;  ///< the path before correction, over the same time
  const correction::MotionLimits& limits;
  const correction::OrientationPolicy& orientation;
  const collision::Query& query;
  const motion::TimeOrigin& origin;        ///< origin of all times
  const std::vector<double>& keyframes_s;  ///< times of the given keyframes, increasing
  const bool is_free;                      ///< whether `path` is proved free of collision
};

/// A path that meets its limits.
struct Retimed {
  motion::TimeLaw law;
  motion::CubicPath path;
  motion::CubicPath interpolated;  ///< the path before correction, by the same law
  /// The check of `path`; empty if its control points did not change. Then the earlier proof still
  /// holds, as proofs are about the parameters of segments and not about times.
  std::optional<PathCheck> check;
};

/// Slows a path only where it breaks its limits, and next to such places
/// (`motion::TimeLaw::within`). That changes the curve a little, and less with closer knots. So
/// knots are placed closer and closer until four conditions hold:
/// - the path meets the limits at every instant;
/// - at samples, no point of the body is farther from its former place than the interval tolerance;
/// - the path meets the orientation policy, compared with the interpolated path under the same law;
/// - the path is proved free of collision.
///
/// Returns nothing if the limit on the number of knots or the deadline comes first. Requires a path
/// that is free and breaks the limits.
std::optional<Retimed> slowed_where_needed(const TooFast& problem, const base::Deadline& deadline);

/// Multiplies all durations of a path by one factor. That changes neither the curve nor the proof.
/// Far from time 0, the sender's times are too coarse for equal factors; then the result is the
/// spline through the same knots, and is searched for collisions again. Returns nothing if the
/// deadline strikes first, or if that spline is not proved free although the path was.
std::optional<Retimed> slowed_uniformly(const TooFast& problem, const base::Deadline& deadline);

/// Moves the times of the keyframes and the remaining collisions of `result`, and sets its
/// slow-down and the parts of its path that were slowed.
void move_times(const motion::TimeLaw& law, PlanResult& result);

/// Moves the times of the collisions and corrections of `result`, which were found before the path
/// was slowed.
void move_findings(const motion::TimeLaw& law, PlanResult& result);

}  // namespace camway::planning
