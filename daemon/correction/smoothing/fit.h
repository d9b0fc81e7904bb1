// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// Returns the coefficients of `free` whose row, added to `base`, is nearest to `wanted`: least
/// squares at times spread over the row. Requires both paths to cover the row, up to where paths
/// end.
Offsets fitted(const FreeCoefficients& free, const motion::CubicPath& wanted,
               const motion::CubicPath& base);

}  // namespace camway::correction
