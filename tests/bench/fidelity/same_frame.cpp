// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/same_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/motion/spline/path_frame.h"
#include "daemon/motion/spline/quaternion_spline.h"

namespace camway::bench {

namespace {

using geometry::Vec4;
using motion::Keyframe;

constexpr int kParts = 32;          // between two joints
constexpr double kSameTime = 1e-9;  // of the duration: such joints are the same

/// The joints of `original`, and those of `path` that are not the same up to rounding.
std::vector<double> joints_of(const motion::CubicPath& original, const motion::Path& path) {
  std::vector<double> joints_s = {original.begin_s()};
  for (const motion::CubicPiece& piece : original.pieces) joints_s.push_back(piece.t1_s);
  const double same_s = kSameTime * (original.end_s() - original.begin_s());
  std::vector<double> others_s;
  for (const motion::Segment& segment : path.segments()) {
    const auto later = std::ranges::lower_bound(joints_s, segment.t1_s - same_s);
    if (later != joints_s.end() && *later > segment.t1_s + same_s) others_s.push_back(segment.t1_s);
  }
  joints_s.insert(joints_s.end(), others_s.begin(), others_s.end());
  std::ranges::sort(joints_s);
  return joints_s;
}

std::vector<double> times_of(const motion::CubicPath& original, const motion::Path& path) {
  const std::vector<double> joints_s = joints_of(original, path);
  std::vector<double> times_s;
  for (std::size_t i = 0; i + 1 < joints_s.size(); ++i) {
    for (int k = 0; k < kParts; ++k) {
      times_s.push_back(std::lerp(joints_s[i], joints_s[i + 1], static_cast<double>(k) / kParts));
    }
  }
  times_s.push_back(joints_s.back());
  return times_s;
}

/// Derivative at the first of three points, from the parabola through them.
Vec4 end_rate_per_s(const motion::CubicPath& through, double end_s, double step_s) {
  const Vec4 first = through.at(end_s).image;
  const Vec4 second = through.at(end_s + step_s).image;
  const Vec4 third = through.at(end_s + 2.0 * step_s).image;
  return (4.0 * second - 3.0 * first - third) / (2.0 * step_s);
}

}  // namespace

motion::CubicPath in_frame_of(const motion::CubicPath& original, const motion::Path& path) {
  std::vector<Keyframe> keyframes;
  Vec4 direction = original.pieces.front().image.front().normalized();
  for (const double time_s : times_of(original, path)) {
    const motion::Pose pose = path.pose(time_s);
    // Nearest to the image before, since a path may turn by more than half a turn.
    direction = motion::image_of(original.reference, geometry::wxyz(pose.orientation), direction);
    keyframes.push_back({time_s, pose, motion::KeyframeOrigin::kInserted, false,
                         original.at(time_s).image.norm() * direction});
  }
  motion::PathFrame frame = motion::frame_of(original);
  frame.begin.velocity_m_per_s =
      motion::derivatives_at(path.segments().front(), 0.0).velocity_m_per_s;
  frame.end.velocity_m_per_s = motion::derivatives_at(path.segments().back(), 1.0).velocity_m_per_s;
  // The rates of the images at the ends are known only once there are images.
  const motion::CubicPath first = motion::interpolate_cubic(keyframes, frame);
  const double begin_step_s = first.pieces.front().t1_s - first.pieces.front().t0_s;
  const double end_step_s = first.pieces.back().t1_s - first.pieces.back().t0_s;
  frame.begin.image_rate_per_s = end_rate_per_s(first, first.begin_s(), begin_step_s);
  frame.end.image_rate_per_s = end_rate_per_s(first, first.end_s(), -end_step_s);
  return motion::interpolate_cubic(keyframes, frame);
}

}  // namespace camway::bench
