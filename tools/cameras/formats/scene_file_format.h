// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// FBX and COLLADA, as `scene::import_cameras` reads them from the file of this name: in single
/// precision, with a pose for each key of what moves the camera. Units and axes are those that the
/// scene of the same file has. A lens that changes is not read.
base::Result<CameraTrack> read_scene_file(const CameraFile& file, const CameraReadOptions& options);

}  // namespace camway::tools
