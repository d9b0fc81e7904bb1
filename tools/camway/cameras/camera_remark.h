// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/scene/import/record/import_options.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// The remark `_camera` of a request, from which `export` writes a file as the imported one was.
struct CameraRemark {
  std::string name;
  std::string format;  ///< empty: the request was not imported
  std::optional<double> fps;
  bool has_times = true;
  std::optional<CameraAxes> axes;  ///< where they are not those of the format
  double scale = 1.0;              ///< metres per unit of the file [Limit: 0 < value]
  scene::UpAxis up = scene::UpAxis::kAsInFile;
  FileFacts facts;
};

/// Returns the remark of a request file; empty where it has none. A member that is none of it, or
/// out of its range, is left out.
CameraRemark camera_remark(const std::string& request_text);

/// Returns the remark as JSON. Members that say nothing are left out.
nlohmann::ordered_json remark_json(const CameraRemark& remark);

/// How poses of a file differ from those of a request.
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
