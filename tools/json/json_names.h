// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request/request.h"

namespace camway::tools {

/// Returns the spelling of a request's members in files, for messages about it. For example
/// "camera.fov_x" becomes "camera.fov_x_deg", because files have degrees.
planning::FieldSpelling json_spelling();

}  // namespace camway::tools
