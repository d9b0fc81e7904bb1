// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/correction/path/constraints.h"
#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// Returns the length of the eye's curve, by Gauss-Legendre quadrature: it hardly depends on how a
/// curve is divided. [Units: metres]
double eye_length_m(const motion::CubicPiece& piece);

/// Returns the length of the eye's curve in metres (`kShortest`) or the bending energy in m²/s³
/// (`kSmoothest`) of a path. Requires one of these two objectives.
double curve_cost(correction::Objective objective, const motion::CubicPath& path);

/// Returns the value of a path by the measure that answers report, over ranges that end at joints:
/// `curve_cost`, or for `kSafest` the largest clearance that is proved (`proved_clearance_m`),
/// which alone is the better the more. Requires any other objective than `kClosest`.
double value_of(correction::Objective objective, const Shot& shot, const motion::CubicPath& path,
                std::span<const TimeRange> ranges);

/// Returns the largest clearance, up to `kClearanceError` of it and at most `sufficient_gap_m`,
/// that is proved for the ranges of a path. `collision::path_clearance`, which answers report,
/// leaves a tenth open. [Units: metres]
double proved_clearance_m(const Shot& shot, const motion::CubicPath& path,
                          std::span<const TimeRange> ranges);
inline constexpr double kClearanceError = 2e-3;

}  // namespace camway::bench
