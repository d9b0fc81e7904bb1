// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/import_options.h"
#include "tools/cameras/camera_track.h"
#include "tools/cameras/export/camera_remark.h"
#include "tools/cameras/track_thinning.h"

namespace camway::tools {

/// The user's own values for the camera, which come before those of its file.
struct ImportLens {
  std::optional<double> fov_x_deg;
  std::optional<double> fov_y_deg;
  std::optional<double> aspect;
  std::optional<double> near_m;
};

/// The full angles of view and the near distance of a request.
struct RequestCamera {
  double fov_x_rad = 0.0;
  double fov_y_rad = 0.0;
  double near_m = 0.0;
};

/// Returns the camera of a track: what the user says, else what the file says, else what follows
/// from the width of the picture, with a note in `track`. A lens that changes counts with its
/// widest angle. Fails if nothing is known of the field of view.
base::Result<RequestCamera> camera_of(CameraTrack& track, const ImportLens& lens);

/// The scene that a request names, and how it is read.
struct RequestScene {
  std::string file;  ///< relative to the request's folder; empty: none
  double scale = 1.0;
  scene::UpAxis up = scene::UpAxis::kAsInFile;
};

/// The moving thing: a camera, or a body beside it or without it.
struct RequestBody {
  std::optional<RequestCamera> camera;
  nlohmann::ordered_json shape;  ///< the member `body` of the request; null: there is none
};

/// Returns the request as JSON, with the kept keys as keyframes and the remark of its file.
nlohmann::ordered_json request_json(const CameraTrack& track, const ThinnedTrack& kept,
                                    const RequestBody& body, const RequestScene& scene,
                                    const CameraRemark& remark);

}  // namespace camway::tools
