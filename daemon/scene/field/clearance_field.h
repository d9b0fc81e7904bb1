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

/// An object's contribution to a `ClearanceField`.
struct PlacedField {
  std::shared_ptr<const DistanceField> field_O;  ///< in the object's frame; null if it has none
  Placement placement;
  geometry::Box bounds_O;  ///< bounds of the object's mesh, in its frame
  geometry::Box bounds_W;  ///< bounds of its triangles in the world, not empty
};

/// A lower bound of the clearance of any point of a scene, without a query of its index. Each
/// object has two bounds: one by its distance field, in its own frame, and one by its box. The
/// result is the least, over all objects, of the larger of the two. No field is computed again when
/// an object moves. Immutable. Thread-safe.
class ClearanceField {
 public:
  /// With more objects than this, planning asks the index directly. A look-up takes about 5 ns per
  /// object, a query of the index some 1 µs.
  static constexpr std::size_t kMaxObjects = 64;

  /// The field of one mesh whose placement is the identity. Requires a field that is not null.
  explicit ClearanceField(std::shared_ptr<const DistanceField> field);
  /// Requires 1 to kMaxObjects objects, of which at least one has a field.
  explicit ClearanceField(std::span<const PlacedField> objects);

  /// Lower bound of the distance from `point_W` to the nearest triangle, rounding included; 0 where
  /// nothing is known: near the scene, and for a point that is not finite. [Units: metres]
  [[nodiscard]] double clearance_at_least_m(const geometry::Vec3& point_W) const {
    return single_ ? single_->clearance_at_least_m(point_W) : least_m(point_W);
  }

  /// The memory of all fields, and the other statistics of the field with the finest cells.
  [[nodiscard]] const DistanceFieldStatistics& statistics() const { return statistics_; }

 private:
  struct Object {
    PlacedField placed;
    double reach_m;  ///< bound of the distance of the mesh from its own origin
  };

  [[nodiscard]] double least_m(const geometry::Vec3& point_W) const;

  std::shared_ptr<const DistanceField> single_;  ///< the field, if it is all there is to ask
  std::vector<Object> objects_;
  DistanceFieldStatistics statistics_;
};

}  // namespace camway::scene
