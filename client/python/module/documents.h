// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "tools/json/json_request.h"

/// Requests and answers of the client as those of planning, and as JSON texts.
namespace camway::python {

/// Returns a request as planning has it, as if a daemon had received it. Throws `Failed` for one
/// that cannot be sent or that a daemon refuses, with the client's and the daemon's texts.
planning::PlanRequest to_planning(const PlanRequest& request);

/// Reads a request, and the mesh of its body where that is a file below `folder`. `source` begins
/// errors. Throws `Failed`.
tools::RequestFile read_request(const std::string& text, const std::string& source,
                                const std::string& folder);

/// The scene in which a result was made.
struct MadeIn {
  std::string scene;
  std::int64_t revision = 0;
  std::string digest;
};

/// Returns a result as the client has the answer of a daemon.
PlanResponse to_answer(const planning::PlanResult& result, const MadeIn& scene);

}  // namespace camway::python
