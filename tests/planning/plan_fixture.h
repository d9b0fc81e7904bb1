// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "daemon/planning/plan.h"
#include "tests/support/scenes.h"

/// Helpers of tests of whole plans.
namespace camway::planning::testing_plan {

inline std::shared_ptr<const scene::Snapshot> snapshot_of(scene::Mesh mesh) {
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

/// Plans without a deadline, so that the result does not depend on the machine's speed or load.
inline PlanResult planned(const scene::Snapshot& snapshot, const PlanRequest& request) {
  return plan(snapshot, request, base::Deadline::never());
}

/// Returns a request of three keyframes on a path that bulges towards +x.
inline PlanRequest bulging_tour() {
  using geometry::Quat;
  PlanRequest request;
  request.scene = "test";
  request.camera = testing::small_camera();
  request.has_times = true;
  request.keyframes = {{0.0, {{0, 0, 2}, Quat::Identity()}},
                       {2.0, {{0.25, 0, 0.4}, Quat::Identity()}},
                       {4.0, {{0, 0, -2}, Quat::Identity()}}};
  return request;
}

}  // namespace camway::planning::testing_plan
