// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/mesh/placement.h"

namespace camway::scene {

/// What bounds the clearance from one object.
struct PlacedField {
  std::shared_ptr<const DistanceField> field_O;  ///< in the object's frame; null if it has none
  Placement placement;
  geometry::Box bounds_O;  ///< of the object's mesh, in its frame
  geometry::Box bounds_W;  ///< of its triangles in the world, not empty
};

/// A lower bound of the clearance of any point of a scene, without asking its index: the least of
/// what the distance field of each object says in the object's own frame, and what the boxes of the
/// objects say. So moving an object computes no field anew. Immutable; safe from any thread.
class ClearanceField {
 public:
  /// With more objects than this the index is asked at once. A look takes about 5 ns an object,
  /// asking the index some 1 µs.
  static constexpr std::size_t kMaxObjects = 64;

  /// Of one mesh that is where it is. Precondition: not null.
  explicit ClearanceField(std::shared_ptr<const DistanceField> field);
  /// Preconditions: at most kMaxObjects; fields are not null everywhere.
  explicit ClearanceField(std::span<const PlacedField> objects);

  /// Never more than the distance from `point_W` to the nearest triangle, rounding included; 0
  /// where nothing is known, so near the scene and for a point that is not finite. [Units: metres]
  [[nodiscard]] double clearance_at_least_m(const geometry::Vec3& point_W) const {
    return single_ ? single_->clearance_at_least_m(point_W) : least_m(point_W);
  }

  /// Of the fields together: their memory, and all else of the one with the finest cells.
  [[nodiscard]] const DistanceFieldStatistics& statistics() const { return statistics_; }

 private:
  struct Object {
    PlacedField placed;
    double reach_m;  ///< no point of the mesh is further from its own origin
  };

  [[nodiscard]] double least_m(const geometry::Vec3& point_W) const;

  std::shared_ptr<const DistanceField> single_;  ///< where there is nothing else to ask
  std::vector<Object> objects_;
  DistanceFieldStatistics statistics_;
};

}  // namespace camway::scene
