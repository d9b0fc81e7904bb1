// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::motion {

/// The first derivatives of a path's splines at one of its ends.
struct PathEnd {
  geometry::Vec3 velocity_m_per_s = geometry::Vec3::Zero();  ///< of the position
  geometry::Vec4 image_rate_per_s =
      geometry::Vec4::Zero();  ///< of the image x(t); q = r·x²/|x|² is the orientation

  bool operator==(const PathEnd&) const = default;
};

/// The part of a path that its keyframes do not determine. A corrected path is a C² cubic spline
/// whose knots are its keyframes, but its reference and its end conditions are those of the path
/// before correction. With them, the keyframes alone give the same path again
/// (`interpolate_cubic`). A value type.
struct PathFrame {
  geometry::Vec4 reference = geometry::Vec4::UnitX();  ///< r in q = r·x²/|x|²; any length above 0
  PathEnd begin;
  PathEnd end;

  bool operator==(const PathFrame&) const = default;
};

/// Returns the C² cubic spline through `keyframes` with the reference and the end derivatives of
/// `frame` (a "complete" spline, cubic_spline.h). One piece per pair of neighbours; nothing is
/// inserted between keyframes, however far apart they are. The spline meets each position bit for
/// bit. The image at a keyframe is:
/// - the keyframe's image, if it represents the orientation to within `kImageAgreement`;
/// - otherwise (the orientation was edited) the point of the same length that represents the
///   orientation and is nearest to the keyframe's image;
/// - if the keyframe has no image, the unit point that represents the orientation and is nearest to
///   the image of the keyframe before. (1, 0, 0, 0) stands in for the keyframe before the first
///   one.
///
/// Positions and images are independent of each other, so an image that is not finite spoils the
/// orientations alone. O(n), deterministic. Requires at least two keyframes, unit quaternions and
/// times strictly increasing.
CubicPath interpolate_cubic(std::span<const Keyframe> keyframes, const PathFrame& frame);

/// An image belongs to an orientation if the unit quaternion that the image represents is within
/// this distance of the orientation's, in R⁴ and up to sign. Rounding stays below 1e-14. An
/// orientation that a person edited differs by more.
inline constexpr double kImageAgreement = 1e-10;

/// Returns the frame of `path`.
PathFrame frame_of(const CubicPath& path);

/// Returns the keyframes that, with `frame_of(path)`, give `path` again: one at each knot of
/// `path`, with its image. The keyframes `given`, increasing in time, stay as they are, except for
/// their images; all others are inserted. Requires `path` to pass through `given`.
std::vector<Keyframe> keyframes_of(const CubicPath& path, std::span<const Keyframe> given);

/// The largest distances between corresponding control points of two paths.
struct PathDifference {
  double position_m = 0.0;  ///< of positions
  double image = 0.0;       ///< of images, in R⁴
};

/// Returns the difference of `a` and `b`; infinity if their pieces differ in number or times. The
/// curves differ by no more than this, because they lie in the hulls of their control points.
PathDifference difference_of(const CubicPath& a, const CubicPath& b);

}  // namespace camway::motion
