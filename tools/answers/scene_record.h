// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/planning/request/request.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/vertical_axis.h"

/// The record of an answer about the scene that it was planned in, and its consequences.
namespace camway::tools {

/// Returns the axis that points up where a request was planned: the one that the axes of the scene
/// were turned to (`up`); else the direction `options.orientation.up` of the policy `level`, if
/// that is nearly an axis; else the one that the cameras of the keyframes show, which stand upright
/// more often than not; y if they show neither. Returns nothing if it would be for the cameras to
/// tell and the body is none: the frame of a robot may have any axis up. `up` is nothing if it is
/// not known how the scene was read.
std::optional<scene::VerticalAxis> vertical_axis(std::optional<scene::UpAxis> up,
                                                 const planning::PlanRequest& request);

/// Returns the sentence that the path of `file` was made for another scene; empty if it was made
/// for the scene with the digest `digest`, or if it is not known for which one (`made_for` is
/// empty).
std::string another_scene(std::string_view file, std::string_view made_for, std::string_view scene,
                          std::string_view digest);

}  // namespace camway::tools
