// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request/request.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Returns the spelling of a request's members in files, for messages about it. For example
/// "camera.fov_x" becomes "camera.fov_x_deg", because files have degrees.
planning::FieldSpelling json_spelling();

/// Returns the spelling of the members of `request`, a document that was read without an error. A
/// member that it has by an old name has that name in messages. Keeps no reference.
planning::FieldSpelling json_spelling(const Field& request);

}  // namespace camway::tools
