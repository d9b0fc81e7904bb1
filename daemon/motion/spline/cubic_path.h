// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "daemon/motion/path/path.h"
#include "daemon/motion/spline/quaternion_spline.h"

namespace camway::motion {

/// One piece of a path before its orientation is squared: both curves are cubic Bézier curves.
struct CubicPiece {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::array<geometry::Vec3, 4> position;  ///< [Units: metres]
  std::array<geometry::Vec4, 4> image;     ///< x(t) of the quaternion spline
};

/// A point of a path in the space in which it is a cubic spline.
struct CubicPoint {
  geometry::Vec3 position = geometry::Vec3::Zero();
  geometry::Vec4 image = geometry::Vec4::Zero();
};

/// The point of a piece at a time, which is clamped to that of the piece.
CubicPoint point_at(const CubicPiece& piece, double time_s);

/// The representation of a path that corrections work on: the C² cubic spline of positions and
/// images that interpolation made, from which the segments of a `Path` follow. Adding any C² bump
/// to the spline keeps it C²; that would not hold for the sextics of the segments. A value type.
struct CubicPath {
  geometry::Vec4 reference = geometry::Vec4::UnitX();  ///< r in q = r·x²/|x|²
  std::vector<CubicPiece> pieces;                      ///< in order of time, without gaps

  /// This function and all below require that the path is not empty. `time_s` is clamped to its
  /// time span.
  [[nodiscard]] double begin_s() const { return pieces.front().t0_s; }
  [[nodiscard]] double end_s() const { return pieces.back().t1_s; }
  [[nodiscard]] CubicPoint at(double time_s) const;
  [[nodiscard]] Pose pose(double time_s) const;
  /// The second derivative with respect to time; at a knot, that of the later piece.
  [[nodiscard]] CubicPoint second_derivative(double time_s) const;

  /// The whole pieces that have more than an end in common with [t_begin_s, t_end_s].
  [[nodiscard]] CubicPath around(double t_begin_s, double t_end_s) const;

  /// Replaces the pieces that cover the time of `part`. Requires `part` to begin and end where
  /// pieces do.
  void replace(const CubicPath& part);

  [[nodiscard]] Path path() const;

 private:
  [[nodiscard]] const CubicPiece& piece_at(double time_s) const;
};

/// Returns the path through `positions` and `images` with slopes `velocities_m_per_s` and
/// `image_rates_per_s` at `times_s`, at least two. All have the same size.
CubicPath cubic_path(const geometry::Vec4& reference, std::span<const double> times_s,
                     std::span<const geometry::Vec3> positions,
                     std::span<const geometry::Vec3> velocities_m_per_s,
                     std::span<const geometry::Vec4> images,
                     std::span<const geometry::Vec4> image_rates_per_s);

/// Derivative of a cubic Bézier curve over `duration_s` at its beginning, times `rate`.
template <class Point>
Point first_slope(const std::array<Point, 4>& curve, double duration_s, double rate = 1.0) {
  return Point((3.0 * rate / duration_s) * (curve[1] - curve[0]));
}
/// Derivative of a cubic Bézier curve over `duration_s` at its end, times `rate`.
template <class Point>
Point last_slope(const std::array<Point, 4>& curve, double duration_s, double rate = 1.0) {
  return Point((3.0 * rate / duration_s) * (curve[3] - curve[2]));
}

/// The pose that `point` represents.
Pose pose_of(const geometry::Vec4& reference, const CubicPoint& point);

}  // namespace camway::motion
