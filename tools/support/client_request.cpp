// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include "client/messages/members.h"
#include "client/messages/plan.h"
#include "daemon/messages/convert.h"

namespace camway::tools {

Bounds to_client_bounds(const geometry::Bounds& bounds) {
  Bounds sent;
  convert(messages::to_wire(bounds), sent);
  return sent;
}

geometry::Bounds from_client_bounds(const Bounds& bounds) {
  bounds_t wire{};
  convert(bounds, wire);
  return messages::from_wire(wire);
}

PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene) {
  PlanRequest sent;
  convert(messages::to_wire(request, {}), sent);
  sent.scene = scene;
  return sent;
}

}  // namespace camway::tools
