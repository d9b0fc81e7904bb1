// SPDX-License-Identifier: MIT
#include "daemon/planning/request/quaternion_order.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace camway::planning {

namespace {

using geometry::Quat;
using geometry::Vec3;

/// How far a camera is rolled about its view against `up_W`, from 0 to pi; nothing where it looks
/// along it.
std::optional<double> roll_rad(const Quat& orientation, const Vec3& up_W) {
  const double across = (orientation * Vec3::UnitX()).dot(up_W);
  const double upward = (orientation * Vec3::UnitY()).dot(up_W);
  // The part of up_W across the view: the sine of the angle between them.
  if (std::hypot(across, upward) < std::sin(kLooksAlong_rad)) return std::nullopt;
  return std::abs(std::atan2(across, upward));
}

/// The quaternion of the same four numbers if they are x, y, z, w.
Quat in_other_order(const Quat& q) {
  const geometry::Vec4 wxyz = geometry::wxyz(q);
  return geometry::from_wxyz({wxyz[3], wxyz[0], wxyz[1], wxyz[2]});
}

bool looks_like_xyzw(std::span<const motion::Keyframe> keyframes, const Vec3& up_W) {
  bool any = false;
  for (const motion::Keyframe& keyframe : keyframes) {
    const Quat q = keyframe.pose.orientation.normalized();
    const std::optional<double> as_read_rad = roll_rad(q, up_W);
    const std::optional<double> other_rad = roll_rad(in_other_order(q), up_W);
    if (!as_read_rad || !other_rad) continue;
    if (!(*as_read_rad > kRolled_rad && *other_rad <= kUpright_rad)) return false;
    any = true;
  }
  return any;
}

}  // namespace

bool looks_like_xyzw(std::span<const motion::Keyframe> keyframes) {
  const std::array<Vec3, 2> ups_W{Vec3::UnitY(), Vec3::UnitZ()};
  for (const Vec3& up_W : ups_W) {
    if (looks_like_xyzw(keyframes, up_W)) return true;
  }
  return false;
}

std::optional<std::string> quaternion_order_warning(const PlanRequest& request) {
  if (!looks_like_xyzw(request.keyframes)) return std::nullopt;
  return fmt::format(
      "{}: all cameras look rolled by more than 60 degrees, and would be upright if the "
      "quaternions were in the order x, y, z, w; they are read as w, x, y, z",
      request.name_of("keyframes[].orientation"));
}

}  // namespace camway::planning
