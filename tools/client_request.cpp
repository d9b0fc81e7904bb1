// SPDX-License-Identifier: MIT
#include "tools/client_request.h"

namespace camway::tools {

PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene) {
  PlanRequest sent;
  sent.scene = scene;
  sent.camera = {request.camera.fov_x_rad, request.camera.fov_y_rad, request.camera.near_m};
  sent.has_times = request.has_times;
  for (const motion::Keyframe& keyframe : request.keyframes) {
    const geometry::Vec3& p = keyframe.pose.position;
    const geometry::Quat& q = keyframe.pose.orientation;
    sent.keyframes.push_back(
        {keyframe.time_s, {p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}, false});
  }
  sent.method = std::string(to_string(request.options.method));
  sent.deadline_s = request.options.deadline_s;
  sent.chord_error_m = request.options.chord_error_m;
  sent.interval_tolerance_m = request.options.interval_tolerance_m;
  sent.max_inserted_keyframes = request.options.max_inserted_keyframes;
  return sent;
}

}  // namespace camway::tools
