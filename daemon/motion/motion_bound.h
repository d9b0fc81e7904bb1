// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/segment.h"

namespace camway::motion {

/// How far the poses of a segment can be from the pose at its middle, u = 1/2.
struct MotionBound {
  double translation_m = 0.0;  ///< of the eye [Limit: value >= 0]
  double turn_rad = 0.0;       ///< angle of the relative rotation [Limit: 0 <= value <= pi]
};

/// Rounding of the positions, in units of the largest control point's length: the value at a
/// parameter, a control point of a part and the middle are 3 convex combinations of 3 roundings
/// each in every coordinate (a factor of sqrt(3) in length), so 16 units of rounding each, and the
/// parameter of the middle is rounded itself (6 more, as no derivative passes 6 times the largest
/// control point). A unit of rounding is half this epsilon; the rest is headroom.
inline constexpr double kTranslationRounding = 32.0 * 2.220446049250313e-16;

/// Rounding of a cone angle, in radians and relative to the ratio of the longest orientation
/// control point to the shortest component along the middle (no value is shorter): 6 convex
/// combinations of 2 roundings each in four coordinates (at most 24 units of rounding of the
/// longest control point) for the value, for the control point of a part and for the middle, and
/// less than 16 for the decomposition into parallel and perpendicular part; halved, as a unit of
/// rounding is half this epsilon. Absolute, as small angles come from the perpendicular part.
inline constexpr double kConeAngleRounding = 44.0 * 2.220446049250313e-16;

/// Bounds the motion of a segment from its control points alone; nothing is sampled.
///
/// Position: the curve lies in the convex hull of its control points, and the largest distance of a
/// point from P(1/2) over a convex set is taken at a vertex. So `translation_m = max |P_i -
/// P(1/2)|`.
///
/// Orientation: vectors within an angle a < 90° of a direction form a convex cone. If all degree-6
/// control points lie within a of Q(1/2), so does every convex combination of them, that is Q(u)
/// for every u. An angle a between unit quaternions is a rotation by 2a. So `turn_rad = 2a`; pi if
/// a control point is 90° or more away or if Q(1/2) is zero, as then the cone says nothing.
///
/// Both are rounded up by the bounds above. Exact in the limit: on short stretches of a regular
/// motion the ratio to the true maximum tends to 1.
MotionBound motion_bound(const Segment& segment);

/// The same for the stretch u0 <= u <= u1 of `segment`, about its pose at (u0 + u1) / 2. Prefer it
/// to bounding a `sub_segment`: the rounding of the sub-division is covered too, which is relative
/// to the control points of the whole. Precondition: 0 <= u0 < u1 <= 1.
MotionBound motion_bound(const Segment& segment, double u0, double u1);

/// No point of a body within `body_radius_m` of the eye is further than this from where it is at
/// the middle pose: the eye moves by `translation_m` at most, and a turn by an angle θ moves a
/// point at radius ρ by at most the chord 2·ρ·sin(θ/2). Rounded up.
double deviation_m(const MotionBound& bound, double body_radius_m);

}  // namespace camway::motion
