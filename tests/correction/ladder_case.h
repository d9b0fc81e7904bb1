// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "daemon/collision/detect.h"
#include "daemon/correction/ladder/ladder.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"

namespace camway::correction {

/// Options that let corrections insert as many keyframes as they need in these scenes.
inline LadderOptions enough_keyframes() {
  LadderOptions options;
  options.max_inserted_keyframes = 200;
  return options;
}

/// A request to the ladder, with its scene in memory.
struct LadderCase {
  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body{testing::small_camera()};
  std::vector<motion::Keyframe> keyframes;
  collision::DetectOptions detect;
  LadderOptions options = enough_keyframes();

  [[nodiscard]] collision::Query query() const {
    return {collision::Obstacles(index), body, detect};
  }
  [[nodiscard]] motion::CubicPath path() const { return motion::interpolate_cubic(keyframes); }
  [[nodiscard]] std::vector<collision::CollisionInterval> collisions(
      const motion::CubicPath& path) const {
    return collision::detect_collisions(query(), path.path(), path.begin_s(), path.end_s(),
                                        base::Deadline::never())
        .value();
  }
  [[nodiscard]] LadderResult corrected() const {
    const motion::CubicPath before = path();
    return correct_by_ladder(std::make_shared<const scene::Mesh>(mesh), query(), keyframes, before,
                             collisions(before), options, base::Deadline::never());
  }
};

inline LadderCase case_with(const scene::Mesh& mesh, std::vector<motion::Keyframe> keyframes) {
  LadderCase c;
  c.mesh = mesh;
  c.index = scene::SceneIndex::build(mesh);
  c.keyframes = std::move(keyframes);
  return c;
}

inline LadderResult corrected_for(Objective objective, LadderCase c) {
  c.options.objective = objective;
  return c.corrected();
}

/// A keyframe with the identity orientation.
inline motion::Keyframe at(double time_s, const geometry::Vec3& position) {
  return {time_s, {position, geometry::Quat::Identity()}};
}

}  // namespace camway::correction
