// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/import/record/import_report.h"

namespace camway::scene {

/// Returns the faces of the file that the mesh is without: "3 of zero area, 1 with a coordinate
/// that ..."; empty if there are none.
std::string faces_left_out(const ImportReport& report);

/// Returns the finest length that matters to a request: the smaller of its interval tolerance and
/// its required clearance, or the tolerance if the clearance is 0.
double finest_length_m(double interval_tolerance_m, double clearance_m);

/// Names the resolution of a request in a warning.
inline constexpr std::string_view kOfRequest = "that the request asks for";
/// Names the one that requests have unless they ask for another.
inline constexpr std::string_view kOfDefault = "that requests ask for by default";

/// Returns the reasons why answers may be wrong about the file, one sentence for each: triangles
/// and faces that were left out, with their numbers; and coordinates that were rounded, or smooth
/// surfaces that were made flat, by more than `resolution_m` (see `finest_length_m`). Without a
/// resolution, neither is mentioned.
std::vector<std::string> import_warnings(const ImportReport& report,
                                         std::optional<double> resolution_m,
                                         std::string_view resolution_name = kOfRequest);

}  // namespace camway::scene
