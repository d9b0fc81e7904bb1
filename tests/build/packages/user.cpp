// SPDX-License-Identifier: MIT
#include <camway/client.h>

#include <cstdio>

/// Plans a path in the scene of the sample configuration, and prints the answer.
int main() {
  camway::Client client;
  camway::PlanRequest request;
  request.scene = "office";
  request.camera.fov_x_rad = 1.4;
  request.camera.fov_y_rad = 1.0;
  request.camera.near_m = 0.15;
  request.keyframes.resize(2);
  request.keyframes[0].position_m = {12.5, 1.6, 12.8};
  request.keyframes[1].position_m = {17.5, 1.6, 17.9};
  for (camway::Keyframe& keyframe : request.keyframes) {
    keyframe.orientation_wxyz = {0.376, 0, -0.927, 0};
  }
  const camway::PlanResponse answer = client.plan(request);
  std::printf("%s\n", (answer.ok() ? answer.message : answer.error).c_str());
  return answer.ok() ? 0 : 1;
}
