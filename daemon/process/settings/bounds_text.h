// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/geometry/bounds.h"

namespace camway::process {

/// The form of bounds, for `--help`.
inline constexpr char kBoundsForm[] = "X0..X1/Y0..Y1/Z0..Z1";

/// Reads `kBoundsForm`, in metres; a number that is left out means no limit: "-3..3/0..2.6/..".
base::Result<geometry::Bounds> parse_bounds(std::string_view text);

/// Writes the same form, with as many digits as it takes to read the same numbers back.
std::string bounds_text(const geometry::Bounds& bounds);

}  // namespace camway::process
