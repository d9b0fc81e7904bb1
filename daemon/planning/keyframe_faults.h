// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::planning {

/// A request of which more keyframes collide has its unit or its axes wrong.
inline constexpr std::size_t kMostKeyframeFaults = 100;

struct KeyframeFaults {
  std::vector<KeyframeFault> faults;
  bool complete = true;  ///< all keyframes were looked at, unless that many are at fault
};

/// The given keyframes at which the body collides, is nearer to the scene than required, or is
/// beyond the bounds of `obstacles`, in order, at most `kMostKeyframeFaults`; each with the nearest
/// free pose, if one was found.
///
/// A free pose lies on that side of every closed surface of the scene on which the path has to be
/// there: where the free keyframes next before and next after are, if these agree. Else there is no
/// path whatever becomes of the one between them. Where no keyframe is free, most of the nearest
/// free poses decide, and outside counts where they are as many. So moving a keyframe there never
/// is what makes a request infeasible. Closed surfaces are those that
/// `correction/infeasibility/closed_surfaces` finds. What is not closed has no sides; there a free
/// pose that is seen from one of these keyframes is preferred, if it is not much further away than
/// the nearest.
///
/// Once the deadline has passed, no more keyframes are looked at, nor free poses looked for.
/// `obstacles` are those of the snapshot.
KeyframeFaults find_keyframe_faults(const scene::Snapshot& snapshot,
                                    const collision::Obstacles& obstacles, const motion::Body& body,
                                    const collision::DetectOptions& detect,
                                    const std::vector<motion::Keyframe>& keyframes,
                                    const collision::Deadline& deadline);

}  // namespace camway::planning
