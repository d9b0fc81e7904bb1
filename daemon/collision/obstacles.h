// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "daemon/geometry/bounds.h"
#include "daemon/geometry/types.h"

namespace camway::scene {
class ClearanceField;
class SceneIndex;
class SceneSolids;
struct Snapshot;
}  // namespace camway::scene

namespace camway::collision {

/// What a path is checked against. Refers to what it was made from, which must outlive it.
struct Obstacles {
  // Implicit on purpose: wherever a scene is asked for, an index or a snapshot will do.
  Obstacles(const scene::SceneIndex& scene_index) : index(scene_index) {}  // NOLINT
  Obstacles(const scene::Snapshot& snapshot);                              // NOLINT

  /// The same, and nothing beyond `limits` either.
  [[nodiscard]] Obstacles within(const geometry::Bounds& limits) const {
    Obstacles both = *this;
    both.bounds = bounds.within(limits);
    return both;
  }
  /// The scene alone.
  [[nodiscard]] Obstacles without_bounds() const {
    Obstacles scene = *this;
    scene.bounds = {};
    return scene;
  }

  /// Obstacles have numbers: the scene's triangles theirs, sides of the bounds the highest there
  /// are, which as signed numbers are -1 to -6.
  static constexpr std::uint32_t number_of_side(std::size_t side) {
    return std::numeric_limits<std::uint32_t>::max() - static_cast<std::uint32_t>(side);
  }
  static constexpr std::size_t side_of(std::uint32_t number) {
    return std::numeric_limits<std::uint32_t>::max() - number;
  }
  static constexpr bool is_side(std::uint32_t number) {
    return side_of(number) < geometry::Bounds::kSides;
  }
  static constexpr std::int64_t signed_number(std::uint32_t number) {
    return is_side(number) ? -1 - static_cast<std::int64_t>(side_of(number)) : number;
  }
  /// Across an obstacle, of any length; 0 for a triangle without area.
  [[nodiscard]] geometry::Vec3 normal_W(std::uint32_t number) const;

  const scene::SceneIndex& index;
  const scene::ClearanceField* field = nullptr;  ///< may be absent: it spares time, no more
  const scene::SceneSolids* solids = nullptr;    ///< null if nothing of the scene has an inside
  geometry::Bounds bounds;                       ///< that the body must not leave
};

}  // namespace camway::collision
