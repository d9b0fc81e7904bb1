// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/stretch.h"

namespace camway::collision {

/// Chooses the triangles of a body that may be near its obstacles, so that a query of a body of
/// many triangles looks at few. Descends the body's tree: a group is passed over where one query
/// proves its ball to be far from the scene and inside the bounds. Of a body without a tree, all
/// triangles are chosen.
///
/// Not thread-safe.
class NearParts {
 public:
  /// Refers to the sources of `obstacles` and to `body`, which must outlive it.
  NearParts(const Obstacles& obstacles, const motion::Body& body);

  /// Chooses triangles for the body as placed for the middle of `stretch`: all that may there be
  /// within `within_m` of a triangle of the scene or of a side of the bounds, and maybe others. All
  /// of them if `within_m` is not finite.
  void choose(const motion::Stretch& stretch, double within_m);

  /// The numbers of the triangles chosen last. Their order depends on the body alone.
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }
  /// Lower bound of the distance of all other triangles from the scene and of their depth inside
  /// the bounds; more than `within_m`. Infinite if there are no others.
  [[nodiscard]] double others_at_least_m() const { return others_at_least_m_; }
  /// Whether one of the others is inside a solid of the scene.
  [[nodiscard]] bool others_are_in_solid() const { return others_are_in_solid_; }

 private:
  void choose_all();
  /// Returns a lower bound of the distance of the point from the scene and of its depth inside the
  /// bounds. It is good enough to be compared with `enough_m`, and may be better.
  [[nodiscard]] double room_at_least_m(const geometry::Vec3& point_W, double enough_m) const;

  const Obstacles obstacles_;
  const motion::BodyTree* tree_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint32_t> waiting_;  ///< nodes still to be looked at
  double others_at_least_m_ = std::numeric_limits<double>::infinity();
  bool others_are_in_solid_ = false;
};

}  // namespace camway::collision
