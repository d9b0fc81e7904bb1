// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <random>

#include "daemon/planning/request/request.h"
#include "daemon/scene/snapshot/scene_object.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::testing {

inline scene::Placement at(const geometry::Vec3& position,
                           const geometry::Quat& orientation = geometry::Quat::Identity()) {
  std::string fault;
  return scene::Placement::make(position, orientation, fault);
}

/// Returns the source of a box object.
inline std::shared_ptr<const scene::ObjectSource> box_source(const geometry::Vec3& size_m) {
  scene::Mesh mesh = *scene::box_mesh(size_m);
  const scene::ImportReport report = scene::report_of(mesh, "box");
  return scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report, {});
}

/// Returns a request with random keyframes of a small camera in a cube of side 8 m.
inline planning::PlanRequest random_path_request(std::size_t keyframes, Random& random) {
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  planning::PlanRequest request;
  request.camera = small_camera();
  for (std::size_t i = 0; i < keyframes; ++i) {
    request.keyframes.push_back(
        {0.0, {geometry::Vec3(place(random), place(random), place(random)), random.rotation()}});
  }
  return request;
}

}  // namespace camway::testing
