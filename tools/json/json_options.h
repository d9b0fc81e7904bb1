// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request/request.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Reads the `options` of a request. A missing option has its default. `planning::visit_options`
/// has the names of the options, and their old names, which are read as well. An example is
///
///     {"deadline_s": 5, "orientation": {"policy": "level", "up": [0, 0, 1], "max_turn_deg": 20},
///      "limits": {"speed_m_per_s": 2, "retime": true}, "bounds": {"max": [10, null, 3]}}
///
/// Angles are in degrees, and directions have any length. Members that another policy of
/// orientation uses are refused, because ignoring them would drop a wish. `planning::validate`
/// checks the ranges.
planning::PlanOptions read_options(const Field& field);

/// Returns the spelling of a request's members in files, for messages about it. For example
/// "camera.fov_x" becomes "camera.fov_x_deg", because files have degrees. A member that the file
/// has by an old name has that name in messages.
planning::FieldSpelling json_spelling(const DocumentNotes& notes = {});

}  // namespace camway::tools
