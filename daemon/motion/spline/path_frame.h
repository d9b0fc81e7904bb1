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
  geometry::Vec4 image_rate_per_s = geometry::Vec4::Zero();  ///< of the image x(t)

  bool operator==(const PathEnd&) const = default;
};

/// The part of a path that its keyframes do not determine. A corrected path is a C² cubic spline
/// whose joints are its keyframes, but its reference and its end conditions are those of the path
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
/// bit. At each orientation, the image is:
/// - the image of the keyframe, where that represents the orientation to `kImageAgreement`;
/// - otherwise, where the keyframe was turned, the point of the same length that represents the
///   orientation and is nearest to that image;
/// - without an image, the point of unit length that is nearest to the image before.
///
/// Positions and images are independent of each other, so an image that is not finite spoils the
/// orientations alone. O(n), deterministic. Requires at least two keyframes, unit quaternions and
/// times strictly increasing.
CubicPath interpolate_cubic(std::span<const Keyframe> keyframes, const PathFrame& frame);

/// Largest distance on S³ of an orientation from the one that an image represents, if that image
/// counts. Rounding of unit quaternions and images is below 1e-14; a person who turns a keyframe
/// turns it by more.
inline constexpr double kImageAgreement = 1e-10;

/// Returns the frame of `path`.
PathFrame frame_of(const CubicPath& path);

/// Returns the keyframes that, with `frame_of(path)`, give `path` again: one at each joint of its
/// pieces, with its image. Those of `given`, increasing in time, stay as they are, except for their
/// images; all others are inserted. Requires the path to pass `given`.
std::vector<Keyframe> keyframes_of(const CubicPath& path, std::span<const Keyframe> given);

/// Returns the largest distance of control points of two paths, of positions and of images, or
/// infinity if the paths have not the same number of pieces at the same times. By it the curves
/// differ by no more, as they lie in the hulls of their control points.
struct PathDifference {
  double position_m = 0.0;
  double image = 0.0;
};
PathDifference difference_of(const CubicPath& a, const CubicPath& b);

}  // namespace camway::motion
