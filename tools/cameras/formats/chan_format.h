// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// Nuke's `.chan`: `frame tx ty tz rx ry rz [fov]`, a line for each frame; angles in degrees, the
/// rotation is Ry · Rx · Rz, the field of view is the vertical one. The rate of frames is not in
/// the file. The first frame is at 0 s.
base::Result<CameraTrack> read_chan(const CameraFile& file, const CameraReadOptions& options);
/// Writes angles that do not jump from one frame to the next.
base::Result<std::string> write_chan(const CameraTrack& track, const CameraWriteOptions& options);

}  // namespace camway::tools
