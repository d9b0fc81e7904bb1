// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/collision/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/planning/result.h"
#include "daemon/scene/scene_index.h"

namespace camway::planning {

/// What is known of a path, whoever made it.
struct PathCheck {
  bool complete = false;  ///< false: the deadline struck, and nothing is known
  std::vector<collision::CollisionInterval> collisions;
  Certificate certificate;  ///< certified exactly if complete and without collisions
};

/// Searches the whole path for collisions and, where there are none, bounds its clearance. The
/// search is the proof: what it does not list is free, at every instant and rounding included
/// (`collision/piece.h`). The clearance has `clearance_deadline`; 0 if that strikes.
PathCheck check_path(const scene::SceneIndex& index, const motion::Path& path,
                     const motion::Corners& corners_C, const collision::DetectOptions& options,
                     const collision::Deadline& deadline,
                     const collision::Deadline& clearance_deadline);

/// The first join at which the camera would jump, as a sentence, or nothing: a path from elsewhere
/// may be free on every segment and still leap through a wall between two. A corner may be off by
/// what rounding explains, at the ends of two segments that share a point.
std::optional<std::string> find_jump(const motion::Path& path, const motion::Corners& corners_C);

}  // namespace camway::planning
