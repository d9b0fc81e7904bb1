// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/motion/path/keyframe.h"

namespace camway::motion {

/// One piece of a path, exactly as it is sent. With `u = (t - t0_s) / (t1_s - t0_s)` the position
/// is the cubic Bézier curve of `position`, and the orientation is the degree-6 Bézier curve of
/// `orientation` (four-vectors in the order w, x, y, z), divided by its length. A path is nothing
/// but these numbers: what is checked is what the receiver evaluates.
struct Segment {
  double t0_s = 0.0;
  double t1_s = 0.0;                          ///< [Limit: value > t0_s]
  std::array<geometry::Vec3, 4> position;     ///< control points in the world frame [Units: metres]
  std::array<geometry::Vec4, 7> orientation;  ///< control points w, x, y, z; not of unit length
};

/// `u` of time `time_s` on `segment`, clamped to [0, 1].
double segment_parameter(const Segment& segment, double time_s);

/// Time of parameter `u`; exactly `t0_s` at 0 and `t1_s` at 1.
double segment_time_s(const Segment& segment, double u);

/// Position at `u` in [0, 1], by de Casteljau.
geometry::Vec3 position_at(const Segment& segment, double u);

/// The orientation's four-vector (w, x, y, z) at `u`, before division by its length.
geometry::Vec4 orientation_numerator_at(const Segment& segment, double u);

/// Pose at `u`; the orientation has unit length. Requires a numerator that is not zero there
/// (`smallest_orientation_weight` proves it for whole segments).
Pose pose_at(const Segment& segment, double u);

/// First and second derivative with respect to *time* of the position and of the *normalised*
/// orientation four-vector at `u`.
struct SegmentDerivatives {
  geometry::Vec3 velocity_m_per_s;
  geometry::Vec3 acceleration_m_per_s2;
  geometry::Vec4 orientation_rate_per_s;
  geometry::Vec4 orientation_acceleration_per_s2;
};
SegmentDerivatives derivatives_at(const Segment& segment, double u);

/// The part of `segment` between parameters `0 <= u0 < u1 <= 1`, exact but for rounding: each
/// control point is a blossom value, a chain of 3 or 6 convex combinations, so its error is at most
/// 6·2 units of rounding of the largest control point. Its first and last control points are the
/// values at `u0` and `u1` bit for bit. Subdivide the original rather than a part, as errors add
/// up.
Segment sub_segment(const Segment& segment, double u0, double u1);

/// Bernstein coefficients of degree 12 of the squared length of the orientation numerator.
std::array<double, 13> orientation_weights(const Segment& segment);

/// Least Bernstein coefficient (degree 12) of the squared length of the orientation numerator.
/// Above zero it proves that the orientation is defined on the whole segment; a value at or below
/// zero proves nothing (subdivide).
double smallest_orientation_weight(const Segment& segment);

}  // namespace camway::motion
