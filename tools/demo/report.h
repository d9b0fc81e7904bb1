// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"

/// The demo's report on an answer. It is computed from the received answer alone.
namespace camway::demo {

/// Returns the given keyframes of an answer, with the times that the daemon derived.
std::vector<motion::Keyframe> given_keyframes(const PlanResponse& response);
/// Returns the given and the inserted keyframes of an answer.
std::vector<motion::Keyframe> all_keyframes(const PlanResponse& response);

/// Returns the path before correction, by interpolating the given keyframes again as the daemon
/// does. Returns an empty path if the answer has no keyframes.
motion::Path path_before(const PlanResponse& response);

motion::Camera to_motion(const Camera& camera);

/// Returns the head of the table of answers.
std::string table_head();
/// Returns the row of one answer.
std::string table_row(const std::string& request, const PlanResponse& response);

}  // namespace camway::demo
