// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include <cmath>
#include <variant>

namespace camway::tools {
namespace {

Body::Point point(const geometry::Vec3& p) { return {p.x(), p.y(), p.z()}; }

std::vector<Body::Point> points(const std::vector<geometry::Vec3>& list) {
  std::vector<Body::Point> sent;
  for (const geometry::Vec3& p : list) sent.push_back(point(p));
  return sent;
}

Body sent_body(const motion::Camera&) { return {}; }
Body sent_body(const motion::BoxShape& box) {
  return Body::box(point(box.size_m), point(box.center_C));
}
Body sent_body(const motion::SphereShape& sphere) {
  return Body::sphere(sphere.radius_m, point(sphere.center_C));
}
Body sent_body(const motion::ConvexShape& convex) {
  std::vector<std::vector<Body::Point>> pieces;
  for (const auto& piece : convex.pieces_C) pieces.push_back(points(piece));
  return Body::convex(std::move(pieces));
}
Body sent_body(const motion::MeshShape& mesh) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (const auto& t : mesh.triangles) {
    triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                         static_cast<std::int32_t>(t[2])});
  }
  return Body::mesh(points(mesh.vertices_C), std::move(triangles));
}

Objective sent_objective(correction::Objective objective) {
  switch (objective) {
    case correction::Objective::kClosest:
      return Objective::kClosest;
    case correction::Objective::kShortest:
      return Objective::kShortest;
    case correction::Objective::kSmoothest:
      return Objective::kSmoothest;
    case correction::Objective::kSafest:
      return Objective::kSafest;
  }
  return Objective::kClosest;
}

Orientation::Policy sent_policy(correction::OrientationRule rule) {
  switch (rule) {
    case correction::OrientationRule::kFree:
      return Orientation::Policy::kFree;
    case correction::OrientationRule::kKeep:
      return Orientation::Policy::kKeep;
    case correction::OrientationRule::kLevel:
      return Orientation::Policy::kLevel;
    case correction::OrientationRule::kTarget:
      return Orientation::Policy::kTarget;
  }
  return Orientation::Policy::kFree;
}

/// Returns the policy with the members that it uses; the daemon refuses others.
Orientation sent_orientation(const correction::OrientationPolicy& policy) {
  Orientation sent;
  sent.policy = sent_policy(policy.rule);
  sent.max_turn_rad = policy.max_turn_rad;
  if (policy.rule == correction::OrientationRule::kLevel) sent.up = point(policy.up_W);
  if (policy.rule == correction::OrientationRule::kTarget) {
    sent.target_m = point(policy.target_W);
    sent.cone_rad = policy.cone_rad;
  }
  return sent;
}

void add_correction_options(const planning::PlanOptions& options, PlanRequest& sent) {
  sent.objective = sent_objective(options.objective);
  sent.orientation = sent_orientation(options.orientation);
  sent.limits = {options.limits.speed_m_per_s, options.limits.acceleration_m_per_s2,
                 options.limits.turn_rate_rad_per_s, options.limits.may_retime};
  sent.bounds = to_client_bounds(options.bounds);
  sent.max_shrink = options.max_shrink;
  sent.repair_keyframes = options.repair_keyframes;
  sent.seed = static_cast<std::int64_t>(options.seed);
}

}  // namespace

Bounds to_client_bounds(const geometry::Bounds& bounds) {
  Bounds sent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isinf(bounds.limit_m(axis))) sent.min_m[axis] = bounds.limit_m(axis);
    if (!std::isinf(bounds.limit_m(axis + 3))) sent.max_m[axis] = bounds.limit_m(axis + 3);
  }
  return sent;
}

geometry::Bounds from_client_bounds(const Bounds& bounds) {
  geometry::Bounds read;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    read.min_W[at] = bounds.min_m[axis].value_or(read.min_W[at]);
    read.max_W[at] = bounds.max_m[axis].value_or(read.max_W[at]);
  }
  return read;
}

PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene) {
  PlanRequest sent;
  sent.scene = scene;
  sent.camera = {request.camera.fov_x_rad, request.camera.fov_y_rad, request.camera.near_m};
  if (request.body) {
    sent.body = std::visit([](const auto& shape) { return sent_body(shape); }, *request.body);
    // A body that is a near quadrilateral is sent as the camera.
    if (const auto* own = std::get_if<motion::Camera>(&*request.body)) {
      sent.camera = {own->fov_x_rad, own->fov_y_rad, own->near_m};
    }
  }
  for (const motion::Keyframe& keyframe : request.keyframes) {
    const geometry::Vec3& p = keyframe.pose.position;
    const geometry::Quat& q = keyframe.pose.orientation;
    sent.keyframes.push_back({request.has_times ? std::optional(keyframe.time_s) : std::nullopt,
                              {p.x(), p.y(), p.z()},
                              {q.w(), q.x(), q.y(), q.z()}});
  }
  sent.method = std::string(to_string(request.options.method));
  sent.deadline_s = request.options.deadline_s;
  sent.chord_error_m = request.options.chord_error_m;
  sent.interval_tolerance_m = request.options.interval_tolerance_m;
  sent.clearance_m = request.options.clearance_m;
  sent.max_inserted_keyframes = request.options.max_inserted_keyframes;
  sent.default_speed_m_per_s = request.options.default_speed_m_per_s.value_or(0.0);
  add_correction_options(request.options, sent);
  return sent;
}

}  // namespace camway::tools
