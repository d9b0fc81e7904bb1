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

}  // namespace camway::tools
