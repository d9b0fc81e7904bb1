// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// COLMAP's `images.txt`: two lines for each image, `id qw qx qy qz tx ty tz camera name` from
/// world to camera (CV) and its points. Poses are in the order of the names. `cameras.txt` beside
/// it has the fields of view. There are no times; `--fps` gives them.
base::Result<CameraTrack> read_colmap(const CameraFile& file, const CameraReadOptions& options);
/// Returns `cameras.txt` for `write_colmap`.
CompanionFile colmap_cameras(const CameraWriteOptions& options);
/// Writes images without points, named by their frame, of camera 1.
base::Result<std::string> write_colmap(const CameraTrack& track, const CameraWriteOptions& options);

}  // namespace camway::tools
