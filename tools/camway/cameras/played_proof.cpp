// SPDX-License-Identifier: MIT
#include "tools/camway/cameras/played_proof.h"

#include "daemon/base/deadline.h"
#include "daemon/collision/obstacles.h"
#include "daemon/planning/stages/path_check.h"
#include "tools/cameras/path_samples.h"
#include "tools/cameras/played_path.h"

namespace camway::tools {
namespace {

constexpr double kHighestFactor = 32.0;

}  // namespace

PlayedProof prove_played(const CameraTrack& track, const ProofScene& scene) {
  const PlayedPath played = played_path(track);
  planning::PlanOptions options = scene.request.options;
  options.clearance_m += played.turn_error_rad * scene.body.radius_m();
  return {search_path({collision::Obstacles(*scene.snapshot).within(scene.bounds), scene.body,
                       planning::detect_options(options)},
                      played.path, base::Deadline::after_s(options.deadline_s)),
          played.turn_error_rad};
}

std::optional<double> free_rate(const motion::Path& path, double fps, const ProofScene& scene) {
  for (double factor = 2.0; factor <= kHighestFactor; factor *= 2.0) {
    const CameraTrack frames = frames_of(path, factor * fps);
    if (prove_played(frames, scene).search.certificate.certified) return factor * fps;
  }
  return std::nullopt;
}

}  // namespace camway::tools
