// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request.h"

namespace camway::tools {

/// How files spell the members of a request, for messages about it: "camera.fov_x" is
/// "camera.fov_x_deg", for there it is in degrees.
planning::FieldSpelling json_spelling();

}  // namespace camway::tools
