// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "daemon/planning/request.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Objectives, as requests and the command line spell them.
inline constexpr std::array<std::pair<std::string_view, correction::Objective>, 4> kObjectives{{
    {"closest", correction::Objective::kClosest},
    {"shortest", correction::Objective::kShortest},
    {"smoothest", correction::Objective::kSmoothest},
    {"safest", correction::Objective::kSafest},
}};

/// Reads the `options` of a request; whatever is missing has its default.
///
///     {"method": "ladder", "deadline_s": s, "clearance": m, "chord_error_m": m,
///      "interval_tolerance_m": m, "max_inserted_keyframes": n,
///      "objective": "closest",
///      "orientation": {"policy": "free", "max_turn_deg": a}   or "keep", likewise, or
///                     {"policy": "level", "up": [x, y, z]}    of any length, or
///                     {"policy": "target", "target": [x, y, z], "cone_deg": a},
///      "limits": {"speed": m/s, "acceleration": m/s², "turn_rate_deg": degrees/s, "retime": true},
///      "bounds": {"min": [x, y, z], "max": [x, y, z]}   each, and each number in it, may be
///      absent:
///                                                        a number by null,
///      "max_shrink": share, "repair_keyframes": true, "seed": n, "default_speed_m_per_s": m/s}
///
/// Members that do not count with the policy at hand are refused: a wish must not be dropped.
/// Ranges are `planning::validate`'s.
planning::PlanOptions read_options(const Field& field);

/// Reads `bounds` of a request or of a response.
geometry::Bounds read_bounds(const Field& field);

}  // namespace camway::tools
