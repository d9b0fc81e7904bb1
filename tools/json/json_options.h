// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Objectives, as requests and the command line spell them.
inline constexpr auto kObjectives = base::named_values<correction::Objective>();

/// Reads the `options` of a request; whatever is missing has its default. `planning::visit_options`
/// has their names. An angle is in degrees, a direction of any length, and in `bounds` each corner
/// may be left out and each number of it be null. Members that do not count with the policy of
/// `orientation` are refused: a wish must not be dropped. Ranges are `planning::validate`'s.
planning::PlanOptions read_options(const Field& field);

/// Reads `bounds` of a request or of a response.
geometry::Bounds read_bounds(const Field& field);

/// Reads the `camera` of a request, of which nothing may be left out.
motion::Camera read_camera(const Field& field);

}  // namespace camway::tools
