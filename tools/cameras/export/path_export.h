// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "daemon/base/result.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

namespace camway::tools {

/// The member of a request file from which an export writes a file of the same kind as that which
/// the request was made of.
inline constexpr char kCameraRemark[] = "_camera";

/// The remark of a request about the camera that it was made of.
struct CameraRemark {
  std::string name;
  std::optional<double> fps;
};
/// Returns the remark of a request file; empty where it has none.
CameraRemark camera_remark(const std::string& request_text);

/// Two documents, and their names in errors.
struct ExportDocuments {
  std::string request_text;
  std::string request_name;
  std::string response_text;
  std::string response_name;
};

/// A path that can be written, and what its file has beside the poses.
struct PathExport {
  double fps = 0.0;
  PathFile response;
  CameraWriteOptions options;
};

/// Reads a response, or a file of a path, for an export: at `fps` frames a second, or those of the
/// file that the request was made of, or 24. `request` is that of the document. Fails where there
/// is no path, no camera, or more than a million frames; errors name the document.
base::Result<PathExport> path_export(const RequestFile& request, const ExportDocuments& documents,
                                     std::optional<double> fps);

/// Returns the file of a path, with a pose for each frame.
base::Result<std::string> exported_frames(const CameraFormat& format, const PathExport& path);

}  // namespace camway::tools
