// SPDX-License-Identifier: MIT
#include "daemon/planning/request/quaternion_order.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

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

/// The quaternion of the same four numbers, read in the other order.
Quat in_other_order(const Quat& q, QuaternionOrder as_read) {
  if (as_read == QuaternionOrder::kXyzw) return {q.x(), q.y(), q.z(), q.w()};
  return {q.z(), q.w(), q.x(), q.y()};
}

bool looks_like_other_order(std::span<const motion::Keyframe> keyframes, QuaternionOrder as_read,
                            const Vec3& up_W) {
  bool any = false;
  for (const motion::Keyframe& keyframe : keyframes) {
    const Quat q = keyframe.pose.orientation.normalized();
    const std::optional<double> as_read_rad = roll_rad(q, up_W);
    const std::optional<double> other_rad = roll_rad(in_other_order(q, as_read), up_W);
    if (!as_read_rad || !other_rad) continue;
    if (!(*as_read_rad > kRolled_rad && *other_rad <= kUpright_rad)) return false;
    any = true;
  }
  return any;
}

}  // namespace

bool looks_like_other_order(std::span<const motion::Keyframe> keyframes, QuaternionOrder as_read) {
  return looks_like_other_order(keyframes, as_read, Vec3::UnitY()) ||
         looks_like_other_order(keyframes, as_read, Vec3::UnitZ());
}

std::optional<std::string> quaternion_order_warning(const PlanRequest& request,
                                                    QuaternionOrder as_read) {
  if (!looks_like_other_order(request.keyframes, as_read)) return std::nullopt;
  constexpr std::string_view kWxyz = "w, x, y, z";
  constexpr std::string_view kXyzw = "x, y, z, w";
  const bool is_wxyz = as_read == QuaternionOrder::kWxyz;
  return fmt::format(
      "{}{}: all cameras look rolled by more than 60 degrees, and would be upright if the "
      "quaternions were in the order {}; they are read as {}",
      request.name_of("keyframes[].orientation"), is_wxyz ? "" : "_xyzw", is_wxyz ? kXyzw : kWxyz,
      is_wxyz ? kWxyz : kXyzw);
}

}  // namespace camway::planning
