// SPDX-License-Identifier: MIT
#include "tools/cameras/played_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::Segment;

constexpr std::size_t kOrientationDegree = std::tuple_size_v<decltype(Segment::orientation)> - 1;

/// The control points of a curve in a higher degree (Farin 2002, section 6.1).
std::array<Vec4, kOrientationDegree + 1> elevated(std::vector<Vec4> points) {
  while (points.size() <= kOrientationDegree) {
    const std::size_t degree = points.size();
    std::vector<Vec4> next(degree + 1);
    next.front() = points.front();
    next.back() = points.back();
    for (std::size_t i = 1; i < degree; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(degree);
      next[i] = share * points[i - 1] + (1.0 - share) * points[i];
    }
    points = std::move(next);
  }
  std::array<Vec4, kOrientationDegree + 1> result;
  std::ranges::copy(points, result.begin());
  return result;
}

/// A line, with orientations blended to the four-vector `end`.
Segment straight(double t0_s, double t1_s, const motion::Pose& from, const motion::Pose& to,
                 const Vec4& end) {
  Segment segment;
  segment.t0_s = t0_s;
  segment.t1_s = t1_s;
  const Vec3 way = to.position - from.position;
  segment.position = {from.position, Vec3(from.position + way / 3.0), Vec3(to.position - way / 3.0),
                      to.position};
  segment.orientation = elevated({geometry::wxyz(from.orientation), end});
  return segment;
}

/// The four-vector of `to` on the side of `from`.
Vec4 on_side_of(const Quat& from, const Quat& to) {
  const Vec4 end = geometry::wxyz(to);
  return end.dot(geometry::wxyz(from)) < 0.0 ? Vec4(-end) : end;
}

/// The angle between the four-vectors of two orientations, on the shorter way.
double image_angle_rad(const Quat& a, const Quat& b) { return 0.5 * a.angularDistance(b); }

/// Adds pieces of a key interval, and returns the largest angle of one.
double add_linear(const CameraTrack& track, std::size_t i, std::vector<Segment>& segments) {
  const TrackKey& from = track.keys[i];
  const TrackKey& to = track.keys[i + 1];
  const double angle_rad = image_angle_rad(from.pose_W.orientation, to.pose_W.orientation);
  const auto pieces =
      static_cast<std::size_t>(std::max(1.0, std::ceil(angle_rad / kLargestPieceAngle_rad)));
  motion::Pose before = from.pose_W;
  double before_s = from.time_s;
  for (std::size_t k = 1; k <= pieces; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(pieces);
    const bool is_last = k == pieces;
    const double time_s = is_last ? to.time_s : from.time_s + share * (to.time_s - from.time_s);
    const motion::Pose pose = is_last ? to.pose_W : pose_at(track, time_s);
    if (!(time_s > before_s)) continue;
    segments.push_back(
        straight(before_s, time_s, before, pose, on_side_of(before.orientation, pose.orientation)));
    before = pose;
    before_s = time_s;
  }
  return angle_rad / static_cast<double>(pieces);
}

void add_blend(const CameraTrack& track, std::size_t i, std::vector<Segment>& segments) {
  const TrackKey& from = track.keys[i];
  const TrackKey& to = track.keys[i + 1];
  segments.push_back(straight(from.time_s, to.time_s, from.pose_W, to.pose_W,
                              geometry::wxyz(to.pose_W.orientation)));
}

void add_cubic(const CameraTrack& track, std::size_t i, std::vector<Segment>& segments) {
  const TrackKey& from = track.keys[i];
  const TrackKey& to = track.keys[i + 1];
  const KeyTangents& out = track.tangents[i];
  const KeyTangents& in = track.tangents[i + 1];
  const double third_s = (to.time_s - from.time_s) / 3.0;
  Segment segment;
  segment.t0_s = from.time_s;
  segment.t1_s = to.time_s;
  segment.position = {
      from.pose_W.position, Vec3(from.pose_W.position + third_s * out.position_out_m_per_s),
      Vec3(to.pose_W.position - third_s * in.position_in_m_per_s), to.pose_W.position};
  const Vec4 begin = geometry::wxyz(from.pose_W.orientation);
  const Vec4 end = geometry::wxyz(to.pose_W.orientation);
  segment.orientation = elevated({begin, Vec4(begin + third_s * out.orientation_out_per_s),
                                  Vec4(end - third_s * in.orientation_in_per_s), end});
  segments.push_back(segment);
}

}  // namespace

PlayedPath played_path(const CameraTrack& track) {
  std::vector<Segment> segments;
  double largest_rad = 0.0;
  for (std::size_t i = 0; i + 1 < track.keys.size(); ++i) {
    if (track.playback == Playback::kCubic) {
      add_cubic(track, i, segments);
    } else if (track.playback == Playback::kBlend) {
      add_blend(track, i, segments);
    } else {
      largest_rad = std::max(largest_rad, add_linear(track, i, segments));
    }
  }
  return {motion::Path(std::move(segments)), std::pow(largest_rad, 3) / 28.0};
}

}  // namespace camway::tools
