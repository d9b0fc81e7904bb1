// SPDX-License-Identifier: MIT
#include "tools/answers/scene_record.h"

#include <fmt/format.h>

#include <cmath>

namespace camway::tools {
namespace {

using geometry::Vec3;
using scene::VerticalAxis;

/// Cosine of the largest angle from an axis, 25 degrees, that a direction counts as that axis at.
constexpr double kNearlyAxis = 0.906;

/// How much the cameras look as if `axis_W` pointed up: an upright camera has its up axis towards
/// it, and its right axis across it.
double uprightness(const planning::PlanRequest& request, const Vec3& axis_W) {
  double sum = 0.0;
  for (const motion::Keyframe& keyframe : request.keyframes) {
    const geometry::Quat& orientation = keyframe.pose.orientation;
    sum += (orientation * Vec3::UnitY()).dot(axis_W);
    sum -= std::abs((orientation * Vec3::UnitX()).dot(axis_W));
  }
  return sum;
}

}  // namespace

std::optional<VerticalAxis> vertical_axis(std::optional<scene::UpAxis> up,
                                          const planning::PlanRequest& request) {
  if (up == scene::UpAxis::kZToY) return VerticalAxis::kY;
  if (up == scene::UpAxis::kYToZ) return VerticalAxis::kZ;
  const correction::OrientationPolicy& policy = request.options.orientation;
  if (policy.rule == correction::OrientationRule::kLevel) {
    if (policy.up_W.y() > kNearlyAxis) return VerticalAxis::kY;
    if (policy.up_W.z() > kNearlyAxis) return VerticalAxis::kZ;
  }
  if (planning::moving_camera(request) == nullptr) return std::nullopt;
  const bool is_z = uprightness(request, Vec3::UnitZ()) > uprightness(request, Vec3::UnitY());
  return is_z ? VerticalAxis::kZ : VerticalAxis::kY;
}

std::string another_scene(std::string_view file, std::string_view made_for, std::string_view scene,
                          std::string_view digest) {
  if (made_for.empty() || made_for == digest) return {};
  return fmt::format("{}: was made for another scene: its scene_digest is {}, that of {} is {}",
                     file, made_for, scene, digest);
}

}  // namespace camway::tools
