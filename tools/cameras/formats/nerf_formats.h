// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

/// Files of programs for radiance fields. Their metres are those of their scene.
namespace camway::tools {

/// nerfstudio's `camera_path.json`: the poses of `camera_path`, camera (GL) to world, 16 numbers by
/// rows, at `fps` or over `seconds`; `fov` is the vertical one, in degrees.
base::Result<CameraTrack> read_nerfstudio(const CameraFile& file, const CameraReadOptions& options);
/// Writes `camera_path` for each frame, and `keyframes` as the program's own viewer reads them.
base::Result<std::string> write_nerfstudio(const CameraTrack& track,
                                           const CameraWriteOptions& options);

/// `transforms.json` of instant-ngp, nerfstudio and Blender's synthetic scenes: `frames`, each with
/// `transform_matrix`, camera (GL) to world, in the order of the file. There are no times; `--fps`
/// gives them.
base::Result<CameraTrack> read_transforms(const CameraFile& file, const CameraReadOptions& options);
base::Result<std::string> write_transforms(const CameraTrack& track,
                                           const CameraWriteOptions& options);

}  // namespace camway::tools
