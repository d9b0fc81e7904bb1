// SPDX-License-Identifier: MIT
// Plans several paths at a time through a scene of a daemon, in C++17, and prints what came of
// them.
#include <camway/client.h>

#include <iostream>
#include <vector>

int main(int argc, char** argv) {
  camway::Client client;
  if (!client.good()) {
    std::cerr << client.error() << '\n';
    return 1;
  }
  camway::PlanRequest request;
  request.scene = argc > 1 ? argv[1] : "office";
  request.keyframes.resize(2);
  request.keyframes[0].position_m = {12.5, 1.6, 12.8};
  request.keyframes[1].position_m = {17.5, 1.6, 17.9};

  std::vector<camway::PendingPlan> pending;
  for (const double clearance_m : {0.0, 0.05, 0.1}) {
    request.clearance_m = clearance_m;
    pending.push_back(client.plan_async(request));
  }
  for (camway::PendingPlan& plan : pending) {
    const camway::PlanResponse answer = plan.answer.get();
    if (!answer.ok()) {
      std::cerr << to_string(answer.status) << ": " << answer.error << '\n';
      return 1;
    }
    std::cout << answer.message << '\n';
    const camway::Pose middle = answer.path.pose((answer.path.begin() + answer.path.end()) / 2);
    std::cout << "  in the middle: " << middle.position_m[0] << ' ' << middle.position_m[1] << ' '
              << middle.position_m[2] << '\n';
  }
}
