// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// The scale on which changes of a path are compared.
///
/// The *shift* of a pose from the interpolated pose at the same time is the angle by which a point
/// moves in the picture that lies at the viewing distance D: turn + move / D, to first order, with
/// the move of the eye. For a body that is no camera it is a bound of the motion of the body's
/// points, divided by D: the move of the body's centre + its radius · turn.
///
/// The *cost* of a corrected path is ∫ shift dt + `kAccelerationWeight_rad` · ∫ (c/a)² dt, where c
/// is the second derivative of the offset of the eye from the interpolated path and a the reference
/// acceleration. The first term makes corrections small and short, the second makes them gentle.
/// A bump of height h on knots s apart costs least at s⁴ = 12 · `kAccelerationWeight_rad` · h · D /
/// a² (`best_spacing_s`), so larger corrections are longer.
struct Closeness {
  double viewing_distance_m = 3.0;  ///< D
  /// A turn by an angle counts as much as a move by this length times the angle: D for a camera,
  /// the radius of the body for another body. [Units: metres]
  double turn_lever_m = 3.0;
  double acceleration_m_per_s2 = 1.0;  ///< a: reference acceleration of the interpolated path
  /// The point whose move counts, in the camera frame: the eye of a camera, the centre of another
  /// body.
  geometry::Vec3 center_C = geometry::Vec3::Zero();

  /// The spacing of the knots of a bump of this height that costs least. [Limit: 0 < height_m]
  [[nodiscard]] double best_spacing_s(double height_m) const;
};

/// Price of a correction that accelerates as much as the path itself: the trade-off between short
/// and gentle corrections. [Units: radians]
inline constexpr double kAccelerationWeight_rad = 0.018;

/// Share of the speed by which turning moves the picture that counts in the reference acceleration:
/// little enough to count only where the eye hardly moves.
inline constexpr double kTurningShare = 0.3;

/// Largest and mean shift of a part of a path. [Units: radians]
struct Shift {
  double largest_rad = 0.0;
  double mean_rad = 0.0;

  bool operator==(const Shift&) const = default;
};

/// Compares `path` with `original`, by samples and a search beside the largest. Requires `original`
/// to cover the time of `path`, with the same reference.
Shift shift_of(const motion::CubicPath& path, const motion::CubicPath& original,
               const Closeness& closeness);

/// The cost of `path`, by samples of the shift; the second term is exact for positions. Requires
/// `original` to cover the time of `path`, with the same reference, and each knot of `original`
/// there to be one of `path`.
/// [Units: radian seconds]
double closeness_cost(const motion::CubicPath& path, const motion::CubicPath& original,
                      const Closeness& closeness);

/// The reference acceleration of an interpolated path: the 99th percentile of its acceleration, and
/// at least that of a circle of the radius `viewing_distance_m` at the mean speed. That is the mean
/// speed of the eye, or `kTurningShare` times that by which turning moves the picture if it is
/// more. Its square is above 0.
double reference_acceleration_m_per_s2(const motion::CubicPath& interpolated,
                                       double viewing_distance_m);

}  // namespace camway::correction
