// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include <cmath>
#include <type_traits>
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

std::array<double, 4> four(const geometry::Vec4& v) { return {v[0], v[1], v[2], v[3]}; }

PathFrame sent_frame(const motion::PathFrame& frame) {
  const auto sent = [](const motion::PathEnd& end) {
    return PathEnd{point(end.velocity_m_per_s), four(end.image_rate_per_s)};
  };
  return {four(frame.reference), sent(frame.begin), sent(frame.end)};
}

/// Copies an option to that of the client. Enumerations have the same values there.
struct OptionSender {
  template <class Mine, class Sent>
  void operator()(const planning::FieldSpec&, const Mine& mine, Sent& sent) const {
    if constexpr (std::is_same_v<Sent, std::string>) {
      sent = base::name_of(mine);
    } else {
      sent = static_cast<Sent>(mine);
    }
  }
  void operator()(const planning::FieldSpec&, const std::optional<double>& mine,
                  double& sent) const {
    sent = mine.value_or(0.0);
  }
  void operator()(const planning::FieldSpec&, const geometry::Bounds& mine, Bounds& sent) const {
    sent = to_client_bounds(mine);
  }
  void operator()(const planning::FieldSpec&, const correction::MotionLimits& mine,
                  MotionLimits& sent) const {
    planning::visit_limits(*this, mine, sent);
  }
  /// Copies the members that the policy uses; the daemon refuses others.
  void operator()(const planning::FieldSpec&, const correction::OrientationPolicy& mine,
                  Orientation& sent) const {
    sent.policy = static_cast<Orientation::Policy>(mine.rule);
    sent.max_turn_rad = mine.max_turn_rad;
    if (mine.rule == correction::OrientationRule::kLevel) sent.up = point(mine.up_W);
    if (mine.rule != correction::OrientationRule::kTarget) return;
    sent.target_m = point(mine.target_W);
    sent.cone_rad = mine.cone_rad;
  }
};

static_assert(static_cast<int>(correction::Objective::kSafest) ==
              static_cast<int>(Objective::kSafest));
static_assert(static_cast<int>(correction::OrientationRule::kTarget) ==
              static_cast<int>(Orientation::Policy::kTarget));

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
                              {q.w(), q.x(), q.y(), q.z()},
                              four(keyframe.image)});
  }
  if (request.frame) sent.frame = sent_frame(*request.frame);
  planning::visit_options(OptionSender{}, request.options, sent);
  return sent;
}

}  // namespace camway::tools
