// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/path_frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "daemon/motion/path/quaternion.h"
#include "daemon/motion/spline/cubic_spline.h"
#include "daemon/motion/spline/quaternion_spline.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;

/// The unit point nearest to `near` that represents the orientation q. The quaternion -q is the
/// same orientation. Its points are at right angles to those of q: a path from one to the other
/// turns the camera once around.
Vec4 nearest_image(const Vec4& reference, const Vec4& q, const Vec4& near) {
  const Vec4 one = image_of(reference, q, near);
  const Vec4 other = image_of(reference, -q, near);
  return other.dot(near) > one.dot(near) ? other : one;
}

/// The image of `keyframe`, whose reference is `reference`; `before` is that of the one before.
Vec4 image_at(const Keyframe& keyframe, const Vec4& reference, const Vec4& before) {
  const Vec4 q = geometry::wxyz(keyframe.pose.orientation);
  const double length = keyframe.image.norm();
  if (!(length > 0.0)) return nearest_image(reference, q, before);
  const Vec4 x = keyframe.image / length;
  const Vec4 shown = quaternion::multiply(reference, quaternion::multiply(x, x));
  const double apart = std::min((shown - q).norm(), (shown + q).norm());
  if (apart <= kImageAgreement) return keyframe.image;
  return length * nearest_image(reference, q, x);
}

/// A keyframe at the beginning, or at the end, of a piece.
Keyframe inserted_at_knot(const CubicPath& path, double time_s, const Vec3& position,
                          const Vec4& image) {
  return {time_s, pose_of(path.reference, {position, image}), KeyframeOrigin::kInserted, false,
          image};
}

/// A value that is no number counts as infinite: no bound may pass it.
void enlarge(double& largest, double value) {
  largest = std::max(largest, std::isnan(value) ? std::numeric_limits<double>::infinity() : value);
}

}  // namespace

CubicPath interpolate_cubic(std::span<const Keyframe> keyframes, const PathFrame& frame) {
  assert(keyframes.size() >= 2);
  const Vec4 reference = frame.reference.normalized();
  std::vector<double> times_s;
  std::vector<Vec3> positions;
  std::vector<Vec4> images;
  for (const Keyframe& keyframe : keyframes) {
    times_s.push_back(keyframe.time_s);
    positions.push_back(keyframe.pose.position);
    const Vec4 before = images.empty() ? Vec4::UnitX() : images.back();
    images.push_back(image_at(keyframe, reference, before));
  }
  const std::vector<Vec3> velocities = spline_slopes<Vec3>(
      times_s, positions, frame.begin.velocity_m_per_s, frame.end.velocity_m_per_s);
  const std::vector<Vec4> rates = spline_slopes<Vec4>(times_s, images, frame.begin.image_rate_per_s,
                                                      frame.end.image_rate_per_s);
  return cubic_path(reference, times_s, positions, velocities, images, rates);
}

PathFrame frame_of(const CubicPath& path) {
  const CubicPiece& first = path.pieces.front();
  const CubicPiece& last = path.pieces.back();
  const double first_s = first.t1_s - first.t0_s;
  const double last_s = last.t1_s - last.t0_s;
  return {path.reference,
          {first_slope(first.position, first_s), first_slope(first.image, first_s)},
          {last_slope(last.position, last_s), last_slope(last.image, last_s)}};
}

std::vector<Keyframe> keyframes_of(const CubicPath& path, std::span<const Keyframe> given) {
  std::vector<Keyframe> keyframes;
  auto next = given.begin();
  const auto take_given = [&](const Vec4& image) {
    keyframes.push_back(*next++);
    keyframes.back().image = image;
  };
  const auto take_knot = [&](double time_s, const Vec3& position, const Vec4& image) {
    while (next != given.end() && next->time_s < time_s) take_given(path.at(next->time_s).image);
    if (next != given.end() && next->time_s == time_s) return take_given(image);
    keyframes.push_back(inserted_at_knot(path, time_s, position, image));
  };
  for (const CubicPiece& piece : path.pieces)
    take_knot(piece.t0_s, piece.position.front(), piece.image.front());
  const CubicPiece& last = path.pieces.back();
  take_knot(last.t1_s, last.position.back(), last.image.back());
  return keyframes;
}

PathDifference difference_of(const CubicPath& a, const CubicPath& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.pieces.size() != b.pieces.size()) return {kInfinity, kInfinity};
  PathDifference difference;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    const CubicPiece& one = a.pieces[i];
    const CubicPiece& other = b.pieces[i];
    if (one.t0_s != other.t0_s || one.t1_s != other.t1_s) return {kInfinity, kInfinity};
    for (std::size_t k = 0; k < 4; ++k) {
      enlarge(difference.position_m, (one.position[k] - other.position[k]).norm());
      enlarge(difference.image, (one.image[k] - other.image[k]).norm());
    }
  }
  return difference;
}

}  // namespace camway::motion
