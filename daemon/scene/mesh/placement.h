// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// The placement of an object in the world: a proper rotation, then a translation. A value type.
///
/// The suffix _W marks coordinates in the frame of the world, _O those in the frame of the object.
/// `orientation_WO` is the rotation that maps from O to W.
class Placement {
 public:
  /// Largest coordinate of a position, and of a placed object. [Units: metres]
  static constexpr double kLargestPlacedCoordinate_m = 1e9;

  /// The identity.
  Placement() = default;

  /// Returns a placement. `orientation_WO` need not be of unit length: it is normalised. Sets
  /// `fault`, and returns the identity, if a number is not finite, the position is beyond
  /// kLargestPlacedCoordinate_m, or the orientation is too near to zero, or too long, to be
  /// normalised.
  static Placement make(const geometry::Vec3& position_W, const geometry::Quat& orientation_WO,
                        std::string& fault);

  /// Returns the placement that has exactly these numbers. Requires numbers that another placement
  /// returned: a second normalisation could change their last digits.
  static Placement of_unit(const geometry::Vec3& position_W, const geometry::Quat& orientation_WO);

  [[nodiscard]] const geometry::Vec3& position_W() const { return position_W_; }
  /// Returns the rotation, of unit length up to rounding.
  [[nodiscard]] const geometry::Quat& orientation_WO() const { return orientation_WO_; }
  /// Returns the placement of a frame that has the axes of the object and begins at `origin_O` in
  /// it. Rounded as `to_world`; without a rotation, the position is a sum that rounds once.
  [[nodiscard]] Placement with_origin(const geometry::Vec3& origin_O) const;
  /// Returns whether both placements hold equal numbers. Then they map every point to equal
  /// coordinates (0 and -0 count as equal).
  bool operator==(const Placement& other) const {
    return position_W_ == other.position_W_ && R_WO_ == other.R_WO_ &&
           orientation_WO_.coeffs() == other.orientation_WO_.coeffs() &&
           is_identity_ == other.is_identity_;
  }
  /// Returns whether this is exactly the identity, which keeps coordinates bit for bit.
  [[nodiscard]] bool is_identity() const { return is_identity_; }

  /// Maps a point from the frame of the object to the world. Rounded; see `error_m`.
  [[nodiscard]] geometry::Vec3 to_world(const geometry::Vec3& point_O) const {
    return is_identity_ ? point_O : geometry::Vec3(R_WO_ * point_O + position_W_);
  }
  /// Maps a point from the world to the frame of the object. Rounded; see `error_m`.
  [[nodiscard]] geometry::Vec3 to_object(const geometry::Vec3& point_W) const {
    return is_identity_ ? point_W : geometry::Vec3(R_WO_.transpose() * (point_W - position_W_));
  }

  /// Error bound of `to_world` and `to_object`: there is one exact rotation and translation that
  /// takes every point within `reach_m` of the origin to a point within this distance of the
  /// computed one.
  ///
  /// With u = 2^-53: a normalised quaternion has a length of 1 ± 4u, so its matrix is 16u from a
  /// rotation, and its entries round by less than 12u in all: 28u of the length of the rotated
  /// vector, which is at most reach + |position|. Differences, products and sums round by 8u more
  /// of it. 64u leave room for the second order.
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

/// Returns `mesh_O` in the world. Paths are proved against these coordinates, as rounded.
Mesh placed_mesh(const Mesh& mesh_O, const Placement& placement);

}  // namespace camway::scene
