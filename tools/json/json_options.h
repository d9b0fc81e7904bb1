// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "daemon/planning/request.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Names of the objectives in requests and on the command line.
inline constexpr std::array<std::pair<std::string_view, correction::Objective>, 4> kObjectives{{
    {"closest", correction::Objective::kClosest},
    {"shortest", correction::Objective::kShortest},
    {"smoothest", correction::Objective::kSmoothest},
    {"safest", correction::Objective::kSafest},
}};

/// Reads the `options` of a request. A missing option has its default.
///
///     {"method": "ladder", "deadline_s": s, "clearance": m, "chord_error_m": m,
///      "interval_tolerance_m": m, "max_inserted_keyframes": n,
///      "objective": "closest",
///      "orientation": {"policy": "free"},
///      "limits": {"speed": m/s, "acceleration": m/s², "turn_rate_deg": degrees/s, "retime": true},
///      "bounds": {"min": [x, y, z], "max": [x, y, z]},
///      "max_shrink": share, "repair_keyframes": true, "seed": n, "default_speed_m_per_s": m/s}
///
/// The policies are "free", "keep", {"policy": "level", "up": [x, y, z]} with `up` of any length,
/// and
/// {"policy": "target", "target": [x, y, z], "cone_deg": a}; each may have a "max_turn_deg".
/// Members of another policy are refused, because ignoring them would drop a wish. Either corner of
/// the bounds may be left out, and null is no limit. `planning::validate` checks the ranges.
planning::PlanOptions read_options(const Field& field);

/// Reads the `bounds` of a request or a response.
geometry::Bounds read_bounds(const Field& field);

}  // namespace camway::tools
