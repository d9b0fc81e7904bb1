// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

#include "daemon/motion/path/keyframe.h"
#include "daemon/planning/request.h"

namespace camway::planning {

/// A camera that is rolled by more looks rolled. [Units: radians] 60 degrees.
inline constexpr double kRolled_rad = 1.0471975511965976;
/// A camera that is rolled by no more looks upright. [Units: radians] 15 degrees.
inline constexpr double kUpright_rad = 0.2617993877991494;
/// Roll says nothing of a camera that looks along the up axis to within this. [Units: radians] 10
/// degrees.
inline constexpr double kLooksAlong_rad = 0.17453292519943295;

/// Whether these quaternions look as if they were written x, y, z, w and read as w, x, y, z: about
/// the axis y or z of the world, one of which is up in most scenes, all cameras are rolled by more
/// than `kRolled_rad`, and in the other order all are upright to `kUpright_rad`. Roll is the angle
/// about the view between the camera's up axis and the plane of view and world's up. A camera that
/// looks along the axis, in either order, is left out; one at least must be left.
bool looks_like_xyzw(std::span<const motion::Keyframe> keyframes);

/// What to tell the sender of such a request, a sentence that names the field; nothing for others.
std::optional<std::string> quaternion_order_warning(const PlanRequest& request);

}  // namespace camway::planning
