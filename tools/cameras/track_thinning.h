// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// How far a path through keyframes may be from the track.
struct ThinningTolerance {
  double position_m = 0.005;
  double turn_rad = 0.0035;  ///< 0.2 degrees
};

/// The poses of a track that become keyframes.
struct ThinnedTrack {
  std::vector<std::size_t> kept;  ///< keys of the track, increasing
  /// Largest differences of the path through the keyframes from the track, at the track's keys.
  double largest_position_m = 0.0;
  double largest_turn_rad = 0.0;
};

/// Chooses few keys so that the smooth path through them (`motion::interpolate`) is within the
/// tolerance of the track at all of its keys. Begins with the first and the last, and adds the
/// worst key of each interval until none is off by more, so it need not find the fewest. Requires a
/// track without fault and at least two keys.
ThinnedTrack thinned(const CameraTrack& track, const ThinningTolerance& tolerance);

/// The first and every `step`-th key after it, and the last. Requires the same and `step` >= 1.
ThinnedTrack every(const CameraTrack& track, std::size_t step);

}  // namespace camway::tools
