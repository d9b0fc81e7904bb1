// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/check.h"

namespace camway::planning {

/// A part of a path that is faster than the limits allow. It is found by samples, for a message to
/// a person.
struct LimitBreach {
  double t_begin_s = 0.0;  ///< the stretch with the largest breach
  double t_end_s = 0.0;
  std::size_t stretches = 1;  ///< how many there are
  std::string rate;           ///< e.g. "its speed is up to 1.4 m/s, of 1 m/s that are allowed"
};

/// Whether the path is shown to meet the limits at every instant, to a millionth.
bool meets_limits(const motion::Path& path, const motion::RateLimits& limits);

/// Returns where `path` is faster than `limits` allow, or nothing if it never is.
std::optional<LimitBreach> find_limit_breach(const motion::Path& path,
                                             const motion::RateLimits& limits);

/// A path that is too fast, and what it must keep when it is slowed.
struct TooFast {
  const motion::CubicPath& path;
  const motion::CubicPath& interpolated;  ///< the path before correction, over the same time
  const correction::MotionLimits& limits;
  const correction::OrientationPolicy& orientation;
  const collision::Query& query;
  const motion::TimeOrigin& origin;        ///< of all times
  const std::vector<double>& keyframes_s;  ///< of the given keyframes, increasing
  const bool is_free;                      ///< `path` is proved free of collision
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

/// Slows a path only where it has to be slowed, and before (`motion::TimeLaw::within`). That
/// changes the curve a little, and less with closer knots. So knots are placed closer and closer
/// until four conditions hold. The path meets the limits at every instant. At samples, no point of
/// the body is farther from its former place than the interval tolerance. Corrections keep to the
/// orientation policy, compared with the interpolated path under the same law. The path is proved
/// free of collision. Returns nothing if a limit on the number of knots or the deadline ends that
/// before. Requires a path that is free and breaks the limits.
std::optional<Retimed> slowed_where_needed(const TooFast& problem, const base::Deadline& deadline);

/// Returns the path with all times stretched by one factor. Far from time 0, times are too coarse
/// for an equal stretch; then the result is the spline through the same joints, and is searched for
/// collisions again. Returns nothing if the deadline strikes first, or if that spline is not as
/// free as the path was.
std::optional<Retimed> slowed_alike(const TooFast& problem, const base::Deadline& deadline);

/// Moves the times of keyframes and remaining collisions, and says in the result where and by how
/// much its path was slowed.
void move_times(const motion::TimeLaw& law, PlanResult& result);

/// Moves the times of what was found before the path was slowed: collisions and corrections.
void move_findings(const motion::TimeLaw& law, PlanResult& result);

}  // namespace camway::planning
