// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "tools/json/json_request.h"
#include "tools/view/orders.h"

namespace camway::tools {

/// A request file for a door, or for a page without one.
struct DoorRequest {
  RequestFile request;
  nlohmann::json document;  ///< the file
};

/// Reads a request as `read_request` does. Refuses what `planning::validate` refuses.
base::Result<DoorRequest> read_door_request(const std::string& file);

/// Returns the order of a request in `scene`, a name. Its text is as the door takes requests: it
/// names the scene and no file, and has the mesh of its body.
view::PlanOrder plan_order(DoorRequest request, const std::string& scene);

/// Returns the name of a scene for places of the door: the file's, with '_' for what they cannot
/// hold.
std::string place_name(const std::string& file);

}  // namespace camway::tools
