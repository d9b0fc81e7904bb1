// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/motion/spline/interpolate.h"
#include "tests/bench/fidelity/shot.h"
#include "tests/support/scenes.h"

/// Small scenes and shots that tests build in memory.
namespace camway::bench {

/// A curved flight of ten metres through six keyframes, in which the camera turns.
inline std::vector<motion::Keyframe> curved_flight(testing::Random& random) {
  std::vector<motion::Keyframe> keyframes;
  for (int i = 0; i < 6; ++i) {
    const geometry::Vec3 position = geometry::Vec3(2.0 * i, 1.0, 0.0) + random.in_cube(0.3);
    const geometry::Quat turned(Eigen::AngleAxisd(random.uniform(-0.3, 0.3), random.direction()));
    keyframes.push_back({2.0 * i, {position, turned}});
  }
  return keyframes;
}

inline BenchRequest request_of(const std::vector<motion::Keyframe>& keyframes) {
  BenchRequest request;
  request.name = "test";
  request.camera = {1.2, 0.9, 0.1};
  request.path = motion::interpolate(keyframes);
  request.keyframes = keyframes.size();
  request.plan.camera = request.camera;
  request.plan.keyframes = keyframes;
  request.plan.has_times = true;
  return request;
}

/// A scene with a large floor, and with a cuboid in the middle of the flight if that is wanted.
inline std::shared_ptr<const scene::Snapshot> scene_of(bool has_cuboid) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-50.0, -6.0, -50.0}, {50.0, -5.0, 50.0});
  if (has_cuboid) testing::add_cuboid(mesh, {4.7, 0.0, -0.5}, {5.3, 1.2, 0.3});
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

}  // namespace camway::bench
