// SPDX-License-Identifier: MIT
#include "tests/messages/request_on_wire.h"

#include "client/messages/plan.h"
#include "tools/support/client_request.h"

namespace camway::messages {

plan_request_t to_wire(const planning::PlanRequest& request, const RequestIds& ids) {
  plan_request_t wire{};
  convert(tools::to_client_request(request, request.scene), wire);
  wire.client_id = ids.client_id;
  wire.request_id = ids.request_id;
  wire.utime = ids.utime;
  wire.num_pages = 1;
  return wire;
}

body_t wire_body(const motion::BodyShape& shape) {
  planning::PlanRequest request;
  request.body.emplace(shape);
  return to_wire(request, {}).body;
}

}  // namespace camway::messages
