// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// Largest number of faults that are searched. A request with more probably has a wrong unit or
/// wrong axes.
inline constexpr std::size_t kMostKeyframeFaults = 100;

struct KeyframeFaults {
  std::vector<KeyframeFault> faults;
  bool complete = true;  ///< all keyframes were checked, or `kMostKeyframeFaults` are at fault
};

/// Returns the given keyframes at which the body collides, is nearer to the scene than required, or
/// is beyond the bounds of `query`. They are in order, at most `kMostKeyframeFaults`, and each has
/// the nearest free pose, if one was found. Once the deadline has passed, neither checks further
/// keyframes nor searches further free poses. Requires a query about `snapshot`.
///
/// A free pose lies on that side of every closed surface of the scene on which the path has to be:
/// the side of the nearest free keyframes before and after it, if these two agree. If they
/// disagree, there is no path wherever the keyframe is moved. If no keyframe is free, the
/// majority of the nearest free poses decides, and a tie counts as outside. So a request does not
/// become infeasible because a keyframe is moved to its free pose. Closed surfaces are those that
/// `scene/mesh/closed_surfaces` finds. A surface that is not closed has no sides;
/// there, a free pose that is visible from one of these two keyframes is preferred, if it is not
/// much further away than the nearest free pose.
KeyframeFaults find_keyframe_faults(const scene::Snapshot& snapshot, const collision::Query& query,
                                    const std::vector<motion::Keyframe>& keyframes,
                                    const base::Deadline& deadline);

}  // namespace camway::planning
