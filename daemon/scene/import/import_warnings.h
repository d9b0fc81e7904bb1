// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/scene/import/record/import_report.h"

namespace camway::scene {

/// The finest length that matters to a request: the smaller of its interval tolerance and its
/// required clearance; without a clearance (0) the tolerance.
double finest_length_m(double interval_tolerance_m, double clearance_m);

/// Reasons why answers may be wrong about the file, a sentence each: triangles and faces that were
/// left out, with their numbers; and coordinates that were rounded by more than `resolution_m` (see
/// `finest_length_m`). Without a resolution rounding is ignored.
std::vector<std::string> import_warnings(const ImportReport& report,
                                         std::optional<double> resolution_m);

}  // namespace camway::scene
