// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// Returns the options of the collision search for a request with these options.
collision::DetectOptions detect_options(const PlanOptions& options);

/// Result of checking a path.
struct PathCheck {
  bool complete = false;  ///< false: the deadline struck, and nothing is known of the path
  std::vector<collision::CollisionInterval> collisions;
  Certificate certificate;  ///< certified exactly if `complete` and without collisions
};

/// Searches the whole path for collisions and, if there are none, bounds its clearance. The search
/// is the proof: outside of the listed collisions the path is free, at every instant and rounding
/// included (`collision/probe.h`). If `clearance_deadline` strikes, the certificate has the
/// required clearance.
PathCheck check_path(const collision::Query& query, const motion::Path& path,
                     const base::Deadline& deadline, const base::Deadline& clearance_deadline);

/// Returns the certificate of a path that was searched already, and found free of collision.
Certificate certificate_of_free(const collision::Query& query, const motion::Path& path,
                                const base::Deadline& clearance_deadline);

}  // namespace camway::planning
