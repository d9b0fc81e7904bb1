// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// glTF 2.0: a camera node and the animation that moves it or what it hangs from. If the camera
/// alone is animated, its keys and curves are those of the file; else the motion is sampled at the
/// rate of frames. glTF has no rate of frames: it is taken from the keys, if they are as far apart
/// as frames of a usual rate.
base::Result<CameraTrack> read_gltf(const CameraFile& file, const CameraReadOptions& options);

/// Writes a `.glb`, or a `.gltf` that holds its buffer, with the camera and its animation, linear
/// or on cubic splines as the track is, in single precision. Times are kept, unless they begin
/// before 0 or later than an hour: then they count from 0.
base::Result<std::string> write_gltf(const CameraTrack& track, const CameraWriteOptions& options);

}  // namespace camway::tools
