// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "daemon/scene/snapshot/scene_store.h"

/// Changes of the scene "bench", for benchmarks of stores.
namespace camway::bench {

/// Throws if the store refuses a change, which would leave nothing to measure.
inline void expect_taken(const scene::StoreResult& result) {
  if (!result.error.empty()) throw std::runtime_error(result.error);
}

inline scene::SceneChange put(const std::string& name, scene::Mesh mesh,
                              const geometry::Vec3& position_W,
                              const scene::ObjectOptions& options = {}) {
  std::string fault;
  const scene::ImportReport report = scene::report_of(mesh, "bench");
  return {scene::SceneChange::Kind::kPut, name,
          scene::make_source(scene::ObjectKind::kMesh, std::move(mesh), report, options),
          scene::Placement::make(position_W, geometry::Quat::Identity(), fault)};
}

/// A move to the next place of a round trip, turning.
inline scene::SceneChange move(const std::string& name, int round) {
  const double turn_rad = 0.1 * round;
  std::string fault;
  return {scene::SceneChange::Kind::kMove, name, nullptr,
          scene::Placement::make(
              geometry::Vec3(5.0 + std::cos(turn_rad), 1.0, 5.0 + std::sin(turn_rad)),
              geometry::Quat(std::cos(turn_rad / 2.0), 0.0, std::sin(turn_rad / 2.0), 0.0), fault)};
}

}  // namespace camway::bench
