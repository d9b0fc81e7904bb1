// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include "client/messages/convert.h"
#include "daemon/messages/converter.h"
#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/option_table.h"

namespace camway {

using messages::ToWire;

// The client's structs have the names of the messages, so `ToWire` fills them in the same way. It
// finds these functions for the pairs of structs that differ.
inline void translate(const geometry::Bounds& mine, Bounds& sent) {
  sent = tools::to_client_bounds(mine);
}
inline void translate(const correction::OrientationPolicy& mine, Orientation& sent) {
  planning::visit_used(ToWire{}, mine, sent);
}

namespace tools {

Bounds to_client_bounds(const geometry::Bounds& bounds) {
  const geometry::OptionalBounds limits = geometry::optional_bounds_of(bounds);
  return {limits.min_m, limits.max_m};
}

PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene) {
  const ToWire io;
  PlanRequest sent;
  sent.scene = scene;
  const motion::Camera* const moving = planning::moving_camera(request);
  io(moving == nullptr ? request.camera : *moving, sent.camera);
  io(request.options, sent);
  if (request.frame) io(*request.frame, sent.frame.emplace());
  for (const motion::Keyframe& keyframe : request.keyframes) {
    keyframe_t wire{};
    io(keyframe, wire);
    convert_common(wire, sent.keyframes.emplace_back());
    if (!request.has_times) sent.keyframes.back().time_s.reset();
  }
  if (!request.body) return sent;
  sent.body.shape = static_cast<Body::Shape>(planning::number_of(*request.body));
  const auto write = [&](const auto& shape) { planning::visit_shape(io, shape, sent.body); };
  std::visit(write, *request.body);
  return sent;
}

}  // namespace tools
}  // namespace camway
