// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include "client/messages/members.h"
#include "daemon/messages/members.h"
#include "daemon/planning/request/body_members.h"

namespace camway {

using messages::ToWire;

// The client's structs have the names of the messages, so `ToWire` fills them in the same way. It
// finds these functions for the pairs of structs that differ.
inline void translate(const geometry::Bounds& mine, Bounds& sent) {
  convert(messages::to_wire(mine), sent);
}
inline void translate(const correction::MotionLimits& mine, MotionLimits& sent) {
  planning::visit_limits(ToWire{}, mine, sent);
}
inline void translate(const correction::OrientationPolicy& mine, Orientation& sent) {
  planning::visit_used(ToWire{}, mine, sent);
}

namespace tools {
namespace {

Keyframe to_client_keyframe(const motion::Keyframe& keyframe, bool has_time) {
  const ToWire io;
  Keyframe sent;
  if (has_time) sent.time_s = keyframe.time_s;
  io(keyframe.pose.position, sent.position_m);
  io(keyframe.pose.orientation, sent.orientation_wxyz);
  io(keyframe.image, sent.image);
  return sent;
}

/// Writes the members of a shape. A near quadrilateral has its size in the request's camera.
struct ShapeWriter {
  Body& body;

  template <class Solid>
  void operator()(const Solid& solid) const {
    planning::visit_shape(ToWire{}, solid, body);
  }
  void operator()(const motion::ConvexShape& convex) const {
    ToWire{}(convex.pieces_C, body.pieces_m);
  }
  void operator()(const motion::MeshShape& mesh) const {
    ToWire{}(mesh.vertices_C, body.vertices_m);
    ToWire{}(mesh.triangles, body.triangles);
  }
};

}  // namespace

Bounds to_client_bounds(const geometry::Bounds& bounds) {
  Bounds sent;
  translate(bounds, sent);
  return sent;
}

geometry::Bounds from_client_bounds(const Bounds& bounds) {
  bounds_t wire{};
  convert(bounds, wire);
  return messages::from_wire(wire);
}

PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene) {
  const ToWire io;
  PlanRequest sent;
  sent.scene = scene;
  const motion::Camera* const moving = planning::moving_camera(request);
  planning::visit_camera(io, moving == nullptr ? request.camera : *moving, sent.camera);
  planning::visit_options(io, request.options, sent);
  if (request.frame) io(*request.frame, sent.frame.emplace());
  for (const motion::Keyframe& keyframe : request.keyframes) {
    sent.keyframes.push_back(to_client_keyframe(keyframe, request.has_times));
  }
  if (!request.body) return sent;
  sent.body.shape = static_cast<Body::Shape>(planning::number_of(*request.body));
  std::visit(ShapeWriter{sent.body}, *request.body);
  return sent;
}

}  // namespace tools
}  // namespace camway
