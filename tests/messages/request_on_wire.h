// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/messages/plan.h"

/// Requests as a client sends them, for tests of what reads them.
namespace camway::messages {

/// Returns the whole request as one page, which may be too large for a message: see `encode_pages`.
plan_request_t to_wire(const planning::PlanRequest& request, const RequestIds& ids);

/// Returns the message for a body. A near quadrilateral has its size in the request's camera.
body_t wire_body(const motion::BodyShape& shape);

}  // namespace camway::messages
