// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/placement.h"

#include <cmath>

namespace camway::scene {

using geometry::Quat;
using geometry::Vec3;

Placement Placement::make(const Vec3& position_W, const Quat& orientation_WO, std::string& fault) {
  // Lengths whose squares neither overflow nor lose digits.
  constexpr double kShortest = 1e-100;
  constexpr double kLongest = 1e100;
  const double length = orientation_WO.coeffs().cwiseAbs().maxCoeff();
  if (!position_W.allFinite() || !orientation_WO.coeffs().allFinite()) {
    fault = "pose: is not finite";
  } else if ((position_W.array().abs() > kLargestPlacedCoordinate_m).any()) {
    fault = "pose: the position is more than 1e9 m from the origin";
  } else if (length < kShortest || length > kLongest) {
    fault = "pose: the orientation has no direction";
  } else {
    return of_unit(position_W, orientation_WO.normalized());
  }
  return {};
}

Placement Placement::of_unit(const Vec3& position_W, const Quat& orientation_WO) {
  Placement placement;
  placement.position_W_ = position_W;
  placement.orientation_WO_ = orientation_WO;
  placement.R_WO_ = orientation_WO.toRotationMatrix();
  placement.is_identity_ = position_W.isZero(0.0) && orientation_WO.vec().isZero(0.0);
  return placement;
}

Placement Placement::with_origin(const Vec3& origin_O) const {
  return origin_O.isZero(0.0) ? *this : of_unit(to_world(origin_O), orientation_WO_);
}

Mesh placed_mesh(const Mesh& mesh_O, const Placement& placement) {
  Mesh mesh = mesh_O;
  for (Vec3& vertex : mesh.vertices) vertex = placement.to_world(vertex);
  return mesh;
}

}  // namespace camway::scene
