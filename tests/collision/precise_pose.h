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

/// The oracle of the crossing campaign: poses and corner curves in extended precision, by code that
/// shares nothing with daemon/motion.
namespace camway::testing {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the oracle must know more than doubles do");
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

/// Half a unit in the last place of 1: what one operation on `Real` rounds by, relatively.
inline constexpr Real kRealRoundoff = std::numeric_limits<Real>::epsilon() / 2;

struct PrecisePose {
  RealVec3 position;
  Eigen::Quaternion<Real> orientation;  ///< unit length
  /// Bound of the error, metres, of a point within `reach_m` of the eye that is taken from one
  /// frame to the other (`precise_pose`).
  Real error_m;

  [[nodiscard]] RealVec3 to_world(const RealVec3& point_C) const;
  [[nodiscard]] RealVec3 to_camera(const geometry::Vec3& point_W) const;
};

/// The pose of `segment` at `u`. `reach_m`: no point asked for is further from the eye.
///
/// Error: the position takes 3 levels of 3 roundings in each coordinate and a difference, 32 units
/// of the largest control point in length; the orientation 36 units of its largest control point,
/// as an angle relative to its own length at most pi/2 times that, doubled by the rotation, and
/// with the normalisation and 40 operations of the rotation fewer than 256 units of the reach.
PrecisePose precise_pose(const motion::Segment& segment, double u, double reach_m);

/// Whether the closed `triangle` crosses the filled near quadrilateral at the pose, by so much that
/// no rounding can explain it: an edge of one passes through the inside of the other. False proves
/// nothing.
bool certainly_touches(const PrecisePose& pose, const motion::Corners& corners_C,
                       const geometry::Triangle& triangle_W);

/// The furthest that the body reaches along a direction over a whole path.
struct Reach {
  Real value_m;         ///< `normal · point` is proved to be at most this, everywhere
  Real reached_m;       ///< and is at least this at the parameter below
  std::size_t segment;  ///< where
  double u;             ///< a multiple of `kGrid`
  std::size_t corner;   ///< which corner of the quadrilateral
};

/// Parameters on this grid, and times of segments that last a second from a whole second on, are
/// exact in doubles for a path of a few thousand segments.
inline constexpr double kGrid = 0x1p-40;
double on_grid(double u);

/// Bounds the reach along the unit vector `normal_W` to within `slack_m`; nothing if that needs
/// more work than it is worth (a reach that stays constant over a stretch). The proof: with W the
/// squared length of the orientation's numerator and N the turned corner times W, the body stays
/// below K exactly where normal·(P·W + N) - K·W is negative, and a polynomial is negative where all
/// its Bernstein coefficients are.
std::optional<Reach> furthest_reach(const motion::Path& path, const motion::Corners& corners_C,
                                    const RealVec3& normal_W, Real slack_m);

}  // namespace camway::testing
