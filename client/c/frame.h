// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/plan.h>

namespace camway::c {

/// Returns the frame of a caller's request. Its numbers are for the daemon to check.
PathFrame frame_of(const camway_path_frame& from);

}  // namespace camway::c
