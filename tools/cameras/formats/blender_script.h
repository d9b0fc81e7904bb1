// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// Writes a script in Python that makes a camera in Blender: lens, frames of the scene, a key for
/// each frame with straight F-curves, and markers where corrections changed the path. The first
/// frame is that of the file that the path came from, else 1.
base::Result<std::string> write_blender_script(const CameraTrack& track,
                                               const CameraWriteOptions& options);

/// Reads the keys of such a script as Blender plays them: in single precision, orientations by the
/// normalised linear blend. Runs nothing, and reads no other scripts.
base::Result<CameraTrack> read_blender_script(const CameraFile& file,
                                              const CameraReadOptions& options);

}  // namespace camway::tools
