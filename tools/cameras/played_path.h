// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/path.h"
#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// A path that is what a program plays of a track, but for a turn.
struct PlayedPath {
  motion::Path path;
  /// The orientation that is played differs from that of `path` at the same time by a turn of this
  /// angle at most; the position does not differ.
  double turn_error_rad = 0.0;
};

/// Returns the path that a track is played on. Positions are exact: lines and cubics are Bézier
/// curves. So are the orientations of a cubic track and of a blend: the normalised curve is the
/// normalised curve of degree 6. Slerp is no rational curve of its parameter. Between two
/// orientations whose four-vectors differ by the angle φ, their normalised linear blend takes the
/// same way at another pace. Pieces are cut, at exact points of slerp, until φ is at most
/// `kLargestPieceAngle_rad`.
///
/// Error of a piece: slerp has turned the four-vector by u·φ at u, the blend by
/// a(u) = atan2(u·sin φ, 1 - u + u·cos φ), so that
/// a - u·φ = -φ³·u(1 - u)(1 - 2u)/6 + O(φ⁵), at most φ³·√3/108 in magnitude (at
/// u = 1/2 ± √3/6). The terms of higher order add less than a tenth for φ below 0.2, and a rotation
/// turns twice as far as its four-vector: 2 · 1.1 · φ³·√3/108 < φ³/28.
///
/// Requires a track without fault and at least two keys.
PlayedPath played_path(const CameraTrack& track);

inline constexpr double kLargestPieceAngle_rad = 0.02;

}  // namespace camway::tools
