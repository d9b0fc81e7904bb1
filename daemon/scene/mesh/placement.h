// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// Where an object is in the world: a proper rotation, then a translation. A value type.
class Placement {
 public:
  /// Positions of objects and what they place are no further than this from the origin.
  static constexpr double kLargestCoordinateM = 1e9;

  /// The world's own frame.
  Placement() = default;

  /// `orientation_WO` need not be of unit length. What is wrong with the two stands in `fault`, and
  /// the placement is that of the world's frame then: numbers that are not finite, a position
  /// beyond kLargestCoordinateM, an orientation too near to zero to have a direction.
  static Placement make(const geometry::Vec3& position_W, const geometry::Quat& orientation_WO,
                        std::string& fault);

  [[nodiscard]] const geometry::Vec3& position_W() const { return position_W_; }
  /// Of unit length, but for rounding.
  [[nodiscard]] const geometry::Quat& orientation_WO() const { return orientation_WO_; }
  /// Whether both take every point to the same bits.
  bool operator==(const Placement& other) const {
    return position_W_ == other.position_W_ && R_WO_ == other.R_WO_ &&
           orientation_WO_.coeffs() == other.orientation_WO_.coeffs() &&
           is_identity_ == other.is_identity_;
  }
  /// Exactly: then objects keep their coordinates bit for bit.
  [[nodiscard]] bool is_identity() const { return is_identity_; }

  /// Where a point of the object is in the world. Rounded; see `error_m`.
  [[nodiscard]] geometry::Vec3 to_world(const geometry::Vec3& point_O) const {
    return is_identity_ ? point_O : geometry::Vec3(R_WO_ * point_O + position_W_);
  }
  /// Where a point of the world is in the frame of the object.
  [[nodiscard]] geometry::Vec3 to_object(const geometry::Vec3& point_W) const {
    return is_identity_ ? point_W : geometry::Vec3(R_WO_.transpose() * (point_W - position_W_));
  }

  /// There is one exact rotation and translation such that every point that `to_world` and
  /// `to_object` give, from a point that is no further than `reach_m` from the origin, lies within
  /// this of where that takes it.
  ///
  /// With u = 2^-53: a normalised quaternion has a length of 1 ± 4u, so that its matrix is 16u from
  /// a rotation, and its entries round by less than 12u in all: 28u of the length of what is
  /// turned. That is at most reach + |position|. Differences, products and sums round by 8u more of
  /// it. 64u leave room for the second order.
  [[nodiscard]] double error_m(double reach_m) const {
    return is_identity_ ? 0.0
                        : 64.0 * geometry::kUnitRoundoff * (reach_m + position_W_.lpNorm<1>());
  }

 private:
  geometry::Vec3 position_W_ = geometry::Vec3::Zero();
  geometry::Quat orientation_WO_ = geometry::Quat::Identity();
  Eigen::Matrix3d R_WO_ = Eigen::Matrix3d::Identity();
  bool is_identity_ = true;
};

/// `mesh` in the world. These very coordinates, rounded as they are, are what paths are proved
/// against.
Mesh placed_mesh(const Mesh& mesh_O, const Placement& placement);

}  // namespace camway::scene
