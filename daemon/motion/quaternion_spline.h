// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::motion {

/// One rational piece of an orientation curve, between two knots.
struct OrientationPiece {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::size_t keyframe = 0;  ///< the piece lies between this keyframe and the next
  std::array<geometry::Vec4, 7> orientation{};  ///< as in Segment
};

/// The rational interpolating quaternion spline (Johnstone & Williams, "Rational control of
/// orientation for animation", 1995): with a reference frame `r`, keyframes are mapped from S³ to
/// R⁴ by `x_i = sqrt(r⁻¹·q_i)`, a cubic spline x(t) interpolates there, and `q(t) = r·x²/|x|²` maps
/// back. The result is a C² rational sextic on S³; its Bernstein coefficients are exact.
///
/// Decisions and deviations:
/// - Signs of the keyframes are aligned first, so that each turn is the shorter way. An exact half
///   turn has no shorter way; it goes counter-clockwise about the axis in the body frame whose
///   leading component is positive (`aligned_orientations`).
/// - The map back is quaternion squaring instead of their four polynomials: they are the same map
/// up
///   to the choice of axes, and squaring shows that a fixed frame on either side cancels.
/// - x_i has unit length (any multiple maps to the same q_i), so weights are near 1.
/// - Neighbours more than 60° apart on S³, or whose x are, get knots half way along their arc and
/// half
///   way in time until they are not (they would have been refused in 1995).
/// - All keyframes on one great circle (turning about one axis): x is exp(n·θ/2) on that circle,
/// for any
///   number of turns. The axis is then exact all along the path, a level camera stays level, and no
///   point of the circle is singular.
/// - End conditions are Bessel's. Turns about nearly one axis, too many for a hemisphere, have `r`
/// orthogonal
///   to their circle; there x(t) must follow a small circle of radius 1/√2, and what it strays from
///   that tilts the camera: TILT_FIGURES.
///
/// Preconditions: at least two orientations, unit quaternions (w, x, y, z), times strictly
/// increasing.
std::vector<OrientationPiece> quaternion_spline(std::span<const double> times_s,
                                                std::span<const geometry::Vec4> orientations);

/// The orientations with signs such that neighbours' dot products are >= 0. A dot product within
/// `kHalfTurnRounding` of zero is a half turn, and its sense is fixed in the body frame: the same
/// from every world frame and for every sign of the input. (Not for the reversed order: a half turn
/// has no sense that both directions of time could share.)
std::vector<geometry::Vec4> aligned_orientations(std::span<const geometry::Vec4> orientations);

/// Rounding of the dot product of two unit quaternions that were rotated and normalised.
inline constexpr double kHalfTurnRounding = 32.0 * 2.220446049250313e-16;

/// Orientations this close to one great circle of S³ (the sine of the angle) are on it: rounding of
/// unit quaternions that were multiplied once or twice.
inline constexpr double kOneAxisRounding = 32.0 * 2.220446049250313e-16;

/// Neighbours further apart than this, on S³ or in the spline's own space, get knots between them.
inline constexpr double kLargestKnotAngle_rad = 1.0471975511965976;  // 60°, as Johnstone's programs

/// Halvings of one pair of keyframes at most. More would be needed only where the polygon passes
/// within a degree or two of `-r`; then x turns faster than a cubic follows well, but q is still C²
/// and exact at the keyframes.
inline constexpr int kMaxKnotHalvings = 6;

}  // namespace camway::motion
