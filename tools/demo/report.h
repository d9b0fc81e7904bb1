// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "daemon/scene/mesh/mesh.h"

/// What the demo tells about an answer. Everything is worked out from what came over the wire.
namespace camway::demo {

/// The given keyframes of an answer, with the times that the daemon derived.
std::vector<motion::Keyframe> given_keyframes(const PlanResponse& response);
/// All of them.
std::vector<motion::Keyframe> all_keyframes(const PlanResponse& response);

/// The path before correction: the daemon's interpolation of the given keyframes, done again here.
/// Empty if the answer has no keyframes.
motion::Path path_before(const PlanResponse& response);

motion::Camera to_motion(const Camera& camera);

/// Names of the scene's objects that the near quadrilateral touches in the collision intervals of
/// the path before correction, in order of appearance.
std::vector<std::string> objects_hit(const scene::Mesh& mesh, const Camera& camera,
                                     const PlanResponse& response);

/// Head and rows of the table.
std::string table_head();
std::string table_row(const std::string& request, const PlanResponse& response,
                      const std::vector<std::string>& objects);

}  // namespace camway::demo
