// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::bench {

/// Returns a cubic path with the reference of `original` that meets `path` at many times: at all
/// joints of both, and between these. It makes paths comparable whose images have another
/// reference, which the cost of corrections requires. Positions of a path whose position is a cubic
/// spline are the same up to rounding; orientations are interpolated between many times, so that
/// the cost is the same to a thousandth. Its images are as long as those of `original`, so that a path that equals `original`
/// has the same images.
///
/// Requires both paths to cover the same time.
motion::CubicPath in_frame_of(const motion::CubicPath& original, const motion::Path& path);

}  // namespace camway::bench
