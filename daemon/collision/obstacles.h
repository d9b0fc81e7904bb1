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

/// The scene and the bounds that a path is checked against. Refers to its sources, which must
/// outlive it.
struct Obstacles {
  explicit Obstacles(const scene::SceneIndex& scene_index) : index(scene_index) {}
  explicit Obstacles(const scene::Snapshot& snapshot);

  /// Returns these obstacles with the intersection of their bounds and `limits`.
  [[nodiscard]] Obstacles within(const geometry::Bounds& limits) const {
    Obstacles both = *this;
    both.bounds = bounds.within(limits);
    return both;
  }
  /// Returns these obstacles without bounds.
  [[nodiscard]] Obstacles without_bounds() const {
    Obstacles scene = *this;
    scene.bounds = {};
    return scene;
  }

  /// Each obstacle has a number. The number of a triangle is its index in the scene. The sides of
  /// the bounds have the six highest numbers; `signed_number` maps these to -1 to -6.
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
  /// A normal of an obstacle, of any length; 0 for a triangle without area.
  [[nodiscard]] geometry::Vec3 normal_W(std::uint32_t number) const;

  const scene::SceneIndex& index;
  /// Distance field that speeds up queries; may be null.
  const scene::ClearanceField* field = nullptr;
  const scene::SceneSolids* solids = nullptr;  ///< solids of the scene; null if it has none
  geometry::Bounds bounds;                     ///< bounds that the body must not leave
  /// How far the smooth surfaces that the triangles stand for may be from them. Probes keep it from
  /// every triangle in addition to the required clearance, so what they prove holds for the smooth
  /// surfaces, too. [Limit: 0 <= value] [Units: metres]
  double surface_error_m = 0.0;
};

}  // namespace camway::collision
