// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/collision/detect.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::planning {

/// A path, and all collisions on it.
struct SearchedPath {
  const motion::Path& path;
  const std::vector<collision::CollisionInterval>& collisions;
};

/// The collisions of a path that was made of one that was searched before, in the time of what was
/// changed: only segments are searched that `known` has not bit for bit at the same time, of the
/// others it is known where they collide. What was found before a search of the whole path was
/// given up is in `begun`.
///
/// Everything outside the intervals is proved free, as for `collision::detect_collisions`; their
/// ends may differ from what that says of the whole path, by the tolerance and by what it joins.
/// Where the deadline strikes, the search is incomplete, and `until_s` is where a stretch of
/// changed segments begins: the collisions are those of the path that is as `known` from there on.
/// Precondition: all with the same body, obstacles and options.
collision::Search search_changes(const collision::Obstacles& obstacles, const motion::Path& path,
                                 const motion::Body& body, const collision::DetectOptions& options,
                                 const SearchedPath& known, const collision::Search& begun,
                                 const collision::Deadline& deadline);

/// `path` up to `from_s`, and from there on `rest`. Precondition: pieces of both begin there, and
/// meet C².
motion::CubicPath with_rest_of(motion::CubicPath path, const motion::CubicPath& rest,
                               double from_s);

}  // namespace camway::planning
