// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/scene/import.h"

namespace camway::scene {

/// What of an import can make an answer wrong about the file, a sentence each: triangles and faces
/// that were left out, with their numbers; and coordinates that were rounded by more than
/// `resolution_m`, the finest length that a request is about (its interval tolerance or, if less,
/// its clearance). Without a resolution rounding is not judged.
std::vector<std::string> import_warnings(const ImportReport& report,
                                         std::optional<double> resolution_m);

}  // namespace camway::scene
