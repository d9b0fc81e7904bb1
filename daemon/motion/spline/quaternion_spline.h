// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::motion {

/// One cubic piece of x(t), between two knots.
struct ImagePiece {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::size_t keyframe = 0;  ///< the piece lies between this keyframe and the next
  std::array<geometry::Vec4, 4> control_points;  ///< Bézier points
};

/// An orientation curve before it is mapped back: the spline x(t) in R⁴ and its reference frame
/// `r`.
struct ImageSpline {
  geometry::Vec4 reference;
  std::vector<ImagePiece> pieces;  ///< in order of time
};

/// The map back, `r·x²`, for one cubic piece of x: Bernstein coefficients as in `Segment`.
std::array<geometry::Vec4, 7> orientation_of(const geometry::Vec4& reference,
                                             const std::array<geometry::Vec4, 4>& image);

/// The point x of unit length with `r·x²` = `orientation` that is nearer to `near`. Discontinuous
/// only where `orientation` is `-r`. Requires unit quaternions.
geometry::Vec4 image_of(const geometry::Vec4& reference, const geometry::Vec4& orientation,
                        const geometry::Vec4& near);

/// The rational interpolating quaternion spline (Johnstone & Williams, "Rational control of
/// orientation for animation", 1995). With a reference frame `r` (reference_frame.h), keyframes are
/// mapped from S³ to R⁴ by `x_i = sqrt(r⁻¹·q_i)`, a cubic spline x(t) interpolates there, and `q(t)
/// = r·x²/|x|²` maps back. The result is a C² rational sextic on S³ with exact Bernstein
/// coefficients.
///
/// Decisions and deviations:
/// - The signs of keyframes are aligned first, so that each turn takes the shorter way
///   (`aligned_orientations`).
/// - The map back is quaternion squaring. The paper's four polynomials are the same map up to the
///   choice of axes.
/// - x_i has unit length (any multiple of it maps to the same q_i), so weights are near 1.
/// - Two neighbours that are more than 60° apart on S³, or whose x are, get a knot half way along
///   their arc and half way in time (at the nearest time that is exact as a sender's time). This is
///   repeated. The authors' programs refuse such data.
/// - Keyframes on one great circle (turns about one axis) have their x on the plane of exp(n·θ/2),
///   for any number of turns: the axis is kept exactly, a level camera stays level, and no point of
///   that circle is singular.
/// - End conditions are Bessel's. Where turns about nearly one axis do not fit in a hemisphere, `r`
///   is orthogonal to their circle and x(t) must follow a small circle. Its deviation from the
///   circle tilts the camera: measured over ten turns with keyframes every 10°, 30°, 60°, 90° of
///   rotation by 0.0002°, 0.014°, 0.22°, 1.1° (natural ends: 0.04°, 0.4°, 1.6°, 3.6°).
///
/// Requires at least two orientations, about unit length (w, x, y, z), and times strictly
/// increasing, counted from `origin`.
ImageSpline quaternion_spline(std::span<const double> times_s,
                              std::span<const geometry::Vec4> orientations,
                              const TimeOrigin& origin = {});

/// The orientations, normalised, with signs such that neighbours' dot products are >= 0. If a dot
/// product is within `kHalfTurnRounding` of zero, the turn is a half turn and neither way is
/// shorter: it goes counter-clockwise about that of the two opposite axes, in the body frame, whose
/// first large component is positive. So the result is the same for every world frame and for every
/// sign of the input. (Not for the reversed order: no rule could achieve that as well, as the
/// reversed turn has the opposite axis.)
std::vector<geometry::Vec4> aligned_orientations(std::span<const geometry::Vec4> orientations);

/// Rounding of the dot product of two unit quaternions that were rotated and normalised.
inline constexpr double kHalfTurnRounding = 32.0 * std::numeric_limits<double>::epsilon();

/// Orientations this close to one great circle of S³ (the sine of the angle) count as on it: the
/// rounding of unit quaternions that were multiplied once or twice.
inline constexpr double kOneAxisRounding = 32.0 * std::numeric_limits<double>::epsilon();

/// Neighbours further apart than this, on S³ or in the space of x, get knots between them: 60°, the
/// limit of Johnstone's programs (2004).
inline constexpr double kLargestKnotAngle_rad = 1.0471975511965976;

/// Largest number of halvings between one pair of keyframes. More would be used only where the
/// polygon passes within a degree or two of `-r`; there x turns faster than a cubic follows well,
/// but q is still C² and meets the keyframes.
inline constexpr int kMaxKnotHalvings = 6;

}  // namespace camway::motion
