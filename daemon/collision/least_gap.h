// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/probe.h"

namespace camway::collision {

/// Lower bound of the gap at the middle of a stretch whose gap was measured by `Probe::refine` with
/// `share`. [Units: metres]
double least_gap_at_middle_m(const Probe& probe, const ProbeResult& measured, double share);

/// Lower bound of the gap everywhere on a stretch, if `at_middle_m` bounds it at the middle.
/// [Units: metres]
double least_gap_m(double at_middle_m, const ProbeResult& seen);

}  // namespace camway::collision
