// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/collision/detect.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::planning {

/// A path with all of its collisions.
struct SearchedPath {
  const motion::Path& path;
  const std::vector<collision::CollisionInterval>& collisions;
};

/// Returns the collisions of `path`, which was made by changing the path of `known`. Searches only
/// segments that `known` does not have bit for bit at the same time, and takes the collisions of
/// all others from `known`. So the cost is that of the changes. `begun`: the result of a search of
/// the whole path, which may have been given up.
///
/// Everything outside the intervals is proved free, as for `collision::detect_collisions`. Their
/// ends may differ from those that `detect_collisions` finds for the whole path, by the tolerance
/// and by the joining distance. If the deadline strikes, the search is incomplete, and `until_s` is
/// the beginning of a run of changed segments; the collisions are then those of the path that
/// equals `known` from there on. Requires the same query for all searches.
collision::FoundCollisions search_changes(const collision::Query& query, const motion::Path& path,
                                          const SearchedPath& known,
                                          const collision::FoundCollisions& begun,
                                          const base::Deadline& deadline);

/// Returns `path` up to `from_s` and `rest` from there on. Requires that pieces of both begin
/// there, and meet C².
motion::CubicPath with_rest_of(motion::CubicPath path, const motion::CubicPath& rest,
                               double from_s);

}  // namespace camway::planning
