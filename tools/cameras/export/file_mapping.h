// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/import/record/import_options.h"
#include "tools/cameras/camera_track.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// Scales and turns a track as a scene file is (`scene::ImportOptions`).
void place_as_scene(CameraTrack& track, double scale, scene::UpAxis up);

/// The differences between the poses of a file and those of a request.
struct FileMapping {
  CameraAxes file_axes = CameraAxes::kGl;    ///< the frame of cameras in the file
  CameraAxes format_axes = CameraAxes::kGl;  ///< the one that the format's writer writes
  double scale = 1.0;
  scene::UpAxis up = scene::UpAxis::kAsInFile;
};

/// Returns a track of a request as the writer of a format is given it.
CameraTrack as_in_file(const CameraTrack& track, const FileMapping& mapping);

/// Returns the option that turns the other way.
scene::UpAxis inverse(scene::UpAxis up);

}  // namespace camway::tools
