// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "tools/cameras/export/file_mapping.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

namespace camway::tools {

/// The user's choices for a file. A missing choice is as in the file that the request was imported
/// from (`CameraRemark`), else as usual for the format.
struct ExportChoices {
  std::optional<std::string> name;
  std::optional<double> fps;
  std::optional<CameraAxes> axes;
  std::optional<double> scale;  ///< metres per unit of the file
  std::optional<scene::UpAxis> up;
  std::optional<double> first_frame;
  std::optional<int> width_px;
  std::optional<int> height_px;
};

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
  bool is_fps_known = false;  ///< whether the user or the imported file said it
  /// Whether the poses are those of the keyframes, as neither the imported file nor the format has
  /// times.
  bool has_keyframes_only = false;
  FileMapping mapping;
  PathFile response;
  const CameraFormat* format = nullptr;
  CameraWriteOptions options;
};

/// Reads a response, or a file of a path, for an export. `request` is that of the document. Fails
/// where there is no path, no camera though the format needs a lens, fewer than two frames, more
/// than a million, or where the format has axes of its own and others are asked for; errors name
/// the document.
base::Result<PathExport> path_export(const RequestFile& request, const ExportDocuments& documents,
                                     const CameraFormat& format, const ExportChoices& choices);

/// Returns the path at its keyframes. Leaves out those whose time is unknown.
std::vector<TrackKey> keyframes_of(const PathFile& response);

/// Returns the poses at the frames. A frame that is a keyframe but for the rounding of a file's
/// times has the keyframe's time, so that the pose is that of the keyframe however fast the camera
/// is.
CameraTrack dense_track(const PathExport& path);

/// Returns the file of a track of the path.
base::Result<std::string> written_file(const PathExport& path, const CameraTrack& track);

}  // namespace camway::tools
