// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "daemon/geometry/types.h"
#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"

/// The oracle of the crossing campaign: poses and corner curves in extended precision. Shares no
/// code with daemon/motion.
namespace camway::testing {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the oracle must know more than doubles do");
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

/// Unit roundoff of `Real`: the largest relative rounding error of one operation.
inline constexpr Real kRealRoundoff = std::numeric_limits<Real>::epsilon() / 2;

struct PrecisePose {
  RealVec3 position;
  Eigen::Quaternion<Real> orientation;  ///< unit length
  /// Bound on the error of converting a point from one frame to the other, for points within
  /// `reach_m` of the eye (see `precise_pose`). [Units: metres]
  Real error_m;

  [[nodiscard]] RealVec3 to_world(const RealVec3& point_C) const;
  [[nodiscard]] RealVec3 to_camera(const geometry::Vec3& point_W) const;
};

/// Returns the pose of `segment` at `u`. `reach_m` bounds the distance of converted points from the
/// eye.
///
/// Error bound, in units of roundoff. Position: 3 levels of 3 roundings in each coordinate and a
/// difference, in length at most 32 units of the largest control point. Orientation: 36 units of
/// the largest control point; relative to the orientation's own length, the angle is at most pi/2
/// times that, and the rotation doubles it. With the normalisation and 40 operations of the
/// rotation the sum is less than 256 units of the reach, times the ratio of the two lengths.
PrecisePose precise_pose(const motion::Segment& segment, double u, double reach_m);

/// Returns whether the closed `triangle_W` crosses the filled near quadrilateral at the pose by
/// more than any rounding: an edge of one passes through the inside of the other. False proves
/// nothing.
bool certainly_touches(const PrecisePose& pose, const motion::Corners& corners_C,
                       const geometry::Triangle& triangle_W);

/// The largest extent of the body along a direction over a whole path.
struct Reach {
  Real value_m;         ///< proved upper bound of `normal · point` over the whole path
  Real reached_m;       ///< value at the parameter below, a lower bound of the largest
  std::size_t segment;  ///< segment of that value
  double u;             ///< parameter of that value, a multiple of `kGrid`
  std::size_t corner;   ///< corner of the quadrilateral with that value
};

/// Grid of parameters. If each segment lasts one second from a whole second on, doubles hold the
/// times of these parameters exactly, for paths of a few thousand segments.
inline constexpr double kGrid = 0x1p-40;
double on_grid(double u);

/// Returns the reach along the unit vector `normal_W` to within `slack_m`. Returns nothing if that
/// takes too many steps, as for a reach that is constant over a time range.
///
/// Proof: let P be the position, W the squared length of the orientation's numerator, and N the
/// rotated corner times W. The corner stays below K exactly where normal·(P·W + N) - K·W is
/// negative. A polynomial is negative where all its Bernstein coefficients are.
std::optional<Reach> furthest_reach(const motion::Path& path, const motion::Corners& corners_C,
                                    const RealVec3& normal_W, Real slack_m);

}  // namespace camway::testing
