// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/interpolate.h"

#include <cassert>
#include <cstddef>

#include "daemon/motion/path/bezier.h"
#include "daemon/motion/spline/cubic_spline.h"
#include "daemon/motion/spline/quaternion_spline.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;

/// Keyframes in the form that the splines take.
struct Columns {
  std::vector<double> times_s;
  std::vector<Vec3> positions;
  std::vector<Vec4> orientations;
};

Columns columns(std::span<const Keyframe> keyframes) {
  Columns result;
  for (const Keyframe& keyframe : keyframes) {
    result.times_s.push_back(keyframe.time_s);
    result.positions.push_back(keyframe.pose.position);
    result.orientations.push_back(geometry::wxyz(keyframe.pose.orientation));
  }
  return result;
}

}  // namespace

CubicPath interpolate_cubic(std::span<const Keyframe> keyframes, const TimeOrigin& origin) {
  assert(keyframes.size() >= 2);
  const Columns data = columns(keyframes);
  const std::vector<Vec3> slopes =
      spline_slopes<Vec3>(data.times_s, data.positions, EndCondition::kNatural);
  const ImageSpline images = quaternion_spline(data.times_s, data.orientations, origin);
  CubicPath result{images.reference, {}};
  for (const ImagePiece& piece : images.pieces) {
    const std::size_t i = piece.keyframe;
    // The pieces of one pair of keyframes share one cubic of the position, at their true times.
    const double from_s = data.times_s[i];
    const double duration_s = data.times_s[i + 1] - from_s;
    result.pieces.push_back(
        {piece.t0_s, piece.t1_s,
         bezier::sub_curve(spline_piece<Vec3>(data.times_s, data.positions, slopes, i),
                           (piece.t0_s - from_s) / duration_s, (piece.t1_s - from_s) / duration_s),
         piece.control_points});
  }
  return result;
}

Path interpolate(std::span<const Keyframe> keyframes, const TimeOrigin& origin) {
  return interpolate_cubic(keyframes, origin).path();
}

}  // namespace camway::motion
