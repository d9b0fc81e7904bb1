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

/// What a path is at one time, in the space where it is a cubic spline.
struct CubicPoint {
  geometry::Vec3 position = geometry::Vec3::Zero();
  geometry::Vec4 image = geometry::Vec4::Zero();
};

/// A path as corrections see it: the C² cubic spline of positions and images that interpolation
/// made, from which the segments of a `Path` follow. Adding a C² bump to it keeps it C², whatever
/// the bump, which would not hold for the segments' own sextics. A value type.
struct CubicPath {
  geometry::Vec4 reference = geometry::Vec4::UnitX();  ///< r in q = r·x²/|x|²
  std::vector<CubicPiece> pieces;                      ///< in order of time, without gap

  /// Preconditions of all: not empty, and `time_s` is clamped to the time span.
  [[nodiscard]] double begin_s() const { return pieces.front().t0_s; }
  [[nodiscard]] double end_s() const { return pieces.back().t1_s; }
  [[nodiscard]] CubicPoint at(double time_s) const;
  [[nodiscard]] Pose pose(double time_s) const;

  /// The pieces that have more than an end in common with [t_begin_s, t_end_s], whole.
  [[nodiscard]] CubicPath around(double t_begin_s, double t_end_s) const;

  /// Puts `part` in the place of the pieces that cover the same time.
  /// Precondition: `part` begins and ends where pieces do.
  void replace(const CubicPath& part);

  [[nodiscard]] Path path() const;
};

/// What `point` stands for.
Pose pose_of(const geometry::Vec4& reference, const CubicPoint& point);

}  // namespace camway::motion
