// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "daemon/motion/path/keyframe.h"
#include "daemon/planning/request/request.h"

namespace camway::planning {

/// A camera whose roll is larger than this looks rolled: 60 degrees. [Units: radians]
inline constexpr double kRolled_rad = std::numbers::pi / 3.0;
/// A camera whose roll is at most this looks upright: 15 degrees. [Units: radians]
inline constexpr double kUpright_rad = std::numbers::pi / 12.0;
/// Roll is not defined for a camera that looks along the up axis to within this angle: 10 degrees.
/// [Units: radians]
inline constexpr double kLooksAlong_rad = std::numbers::pi / 18.0;

/// Order of the four numbers of a quaternion in a message or file.
enum class QuaternionOrder { kWxyz, kXyzw };

/// Returns whether the quaternions, read in the order `as_read`, seem to be written in the other
/// one. They do if, with y or with z as the world's up axis, every camera is rolled by more than
/// `kRolled_rad` as read and by at most `kUpright_rad` in the other order. Roll is the angle about
/// the viewing direction between the camera's up axis and the plane of the viewing direction and
/// the world's up axis. Cameras that look along the up axis in either order are left out; returns
/// false if no camera is left. With z up, half of the headings look upright in both orders.
bool looks_like_other_order(std::span<const motion::Keyframe> keyframes,
                            QuaternionOrder as_read = QuaternionOrder::kWxyz);

/// Returns a sentence for the sender of such a request, which names the field; nothing if
/// `looks_like_other_order` is false.
std::optional<std::string> quaternion_order_warning(
    const PlanRequest& request, QuaternionOrder as_read = QuaternionOrder::kWxyz);

}  // namespace camway::planning
