// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/view/backend.h"

namespace camway::view {

/// Returns the floor plan of the last plan as SVG, without walls if its triangles are not known.
std::string plan_picture(const LastPlan& last);

}  // namespace camway::view
