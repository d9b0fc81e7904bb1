// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::motion {

/// End conditions of an interpolating cubic spline, where C² leaves one degree of freedom.
enum class EndCondition {
  /// No second derivative: least bending energy of all interpolants (Farin 2002, section 9.4).
  kNatural,
  /// The slope of the parabola through the three points at the end (Farin 2002, section 9.3): the
  /// error near the ends is of third order in the spacing instead of second. A line for two points.
  kBessel,
};

/// Slopes, with respect to the knots, of the C² cubic spline that interpolates `points` at `knots`.
/// Solved for slopes and not for second derivatives, so that C¹ is exact and C² good to rounding.
/// The system is diagonally dominant whatever the knots; O(n). Linear in the points, so the curve
/// is the same in every frame; symmetric under reversal.
///
/// Requires at least two knots, strictly increasing, and as many points.
template <class Point>
std::vector<Point> spline_slopes(std::span<const double> knots, std::span<const Point> points,
                                 EndCondition ends);

extern template std::vector<geometry::Vec3> spline_slopes(std::span<const double>,
                                                          std::span<const geometry::Vec3>,
                                                          EndCondition);
extern template std::vector<geometry::Vec4> spline_slopes(std::span<const double>,
                                                          std::span<const geometry::Vec4>,
                                                          EndCondition);

/// As above, with given slopes at the two ends ("complete" spline). If they are those of a smooth
/// curve, the error is of fourth order in the spacing up to the ends (de Boor 2001, chapter V).
template <class Point>
std::vector<Point> spline_slopes(std::span<const double> knots, std::span<const Point> points,
                                 const Point& first_slope, const Point& last_slope);

extern template std::vector<geometry::Vec3> spline_slopes(std::span<const double>,
                                                          std::span<const geometry::Vec3>,
                                                          const geometry::Vec3&,
                                                          const geometry::Vec3&);
extern template std::vector<geometry::Vec4> spline_slopes(std::span<const double>,
                                                          std::span<const geometry::Vec4>,
                                                          const geometry::Vec4&,
                                                          const geometry::Vec4&);

/// Bézier points of the spline's piece between knots `i` and `i + 1`. The outer two are the
/// interpolated points, bit for bit.
template <class Point>
std::array<Point, 4> spline_piece(std::span<const double> knots, std::span<const Point> points,
                                  std::span<const Point> slopes, std::size_t i) {
  const double third = (knots[i + 1] - knots[i]) / 3.0;
  return {points[i], Point(points[i] + third * slopes[i]),
          Point(points[i + 1] - third * slopes[i + 1]), points[i + 1]};
}

}  // namespace camway::motion
