// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/motion/path/path.h"
#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// Returns the poses of a path at its frames: from its begin, `fps` times a second. The last frame
/// is the last one that is not after the end of the path, which counts as on a frame if it is
/// `kOnFrame` off. Times count from `begin_s`.
/// Orientations of neighbours are on the same side of the sphere of quaternions. Requires a path
/// and 0 < fps.
CameraTrack frames_of(const motion::Path& path, double fps, double begin_s = 0.0);

/// Returns a track with keys at its frames, beside its own, as its program plays it; the same track
/// if it has no times, or a key for each frame already. The rate is that of the track, or 24 frames
/// a second. Requires a track without fault.
CameraTrack with_frames_between(const CameraTrack& track);

/// Returns the poses of a path at these times. Requires increasing times, within the path.
CameraTrack poses_at(const motion::Path& path, std::span<const double> times_s);

/// The number of frames that `frames_of` makes; too many to be counted are infinite.
double frame_count(const motion::Path& path, double fps);

}  // namespace camway::tools
