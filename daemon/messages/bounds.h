// SPDX-License-Identifier: MIT
#pragma once

#include <camway/bounds_t.hpp>

#include "daemon/geometry/bounds.h"

namespace camway::messages {

bounds_t wire_bounds(const geometry::Bounds& bounds);

/// Converts without a check; `geometry::fault_in` checks the numbers.
geometry::Bounds bounds_of(const bounds_t& wire);

}  // namespace camway::messages
