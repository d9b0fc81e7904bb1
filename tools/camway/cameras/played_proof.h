// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/answers/path_search.h"
#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// The scene, the body and the options that a camera path is proved against.
struct ProofScene {
  planning::PlanRequest request;
  motion::Body body;
  std::shared_ptr<const scene::Snapshot> snapshot;
  geometry::Bounds bounds;
};

/// The search of what a program plays of a track, between its keys, too.
struct PlayedProof {
  PathSearch search;
  double turn_error_rad = 0.0;  ///< `PlayedPath`; it was added to the clearance
};

/// Searches what is played of a track for collisions, with the clearance of the request. The
/// clearance is increased by what the turn of `PlayedPath` moves the farthest point of the body.
/// Requires a track without fault and at least two keys.
PlayedProof prove_played(const CameraTrack& track, const ProofScene& scene);

/// Returns the lowest rate of `fps` times 2, 4, 8, 16 and 32 at whose frames a path, played on
/// straight lines between them, is free; nothing if at none.
std::optional<double> free_rate(const motion::Path& path, double fps, const ProofScene& scene);

}  // namespace camway::tools
