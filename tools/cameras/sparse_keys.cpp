// SPDX-License-Identifier: MIT
#include "tools/cameras/sparse_keys.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "tools/cameras/frame_rate.h"

namespace camway::tools {
namespace {

using geometry::Vec4;

/// The unit quaternion of a segment and its derivatives, at one end or between.
struct Side {
  geometry::Vec3 velocity_m_per_s;
  Vec4 orientation;
  Vec4 orientation_rate_per_s;
};

Side side_at(const motion::Segment& segment, double u) {
  const motion::SegmentDerivatives derivatives = motion::derivatives_at(segment, u);
  return {derivatives.velocity_m_per_s, motion::orientation_numerator_at(segment, u).normalized(),
          derivatives.orientation_rate_per_s};
}

/// The same orientation on the side of the sphere that `near` is on.
void turn_towards(const Vec4& near, Side& side) {
  if (side.orientation.dot(near) >= 0.0) return;
  side.orientation = -side.orientation;
  side.orientation_rate_per_s = -side.orientation_rate_per_s;
}

double tolerances_off(const motion::Pose& pose, const motion::Pose& played,
                      const ThinningTolerance& tolerance) {
  return std::max((pose.position - played.position).norm() / tolerance.position_m,
                  pose.orientation.angularDistance(played.orientation) / tolerance.turn_rad);
}

/// Whether a time is that of a join but for rounding, which is then the candidate.
bool is_at_join(const std::vector<double>& joins_s, double time_s, double fps) {
  const double near_s = kOnFrame / fps;
  const auto after = std::ranges::lower_bound(joins_s, time_s - near_s);
  return after != joins_s.end() && *after <= time_s + near_s;
}

}  // namespace

SparseKeys::SparseKeys(const motion::Path& path, double fps) {
  std::vector<double> times;
  for (const motion::Segment& segment : path.segments()) times.push_back(segment.t0_s);
  times.push_back(path.end_s());
  const std::vector<double> joins_s = times;
  const double step_s = 1.0 / (fps * kCandidatesPerFrame);
  const auto steps = static_cast<std::size_t>((path.end_s() - path.begin_s()) / step_s);
  for (std::size_t i = 1; i <= steps; ++i) {
    const double time_s = std::min(path.begin_s() + static_cast<double>(i) * step_s, path.end_s());
    if (!is_at_join(joins_s, time_s, fps)) times.push_back(time_s);
  }
  std::ranges::sort(times);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  times.erase(std::unique(times.begin(), times.end()), times.end());
  for (const double time_s : times) add_candidate(path, time_s);
  mark_frames(fps);
  for (const motion::Segment& segment : path.segments()) {
    const auto found = std::ranges::lower_bound(times, segment.t0_s);
    kept_.push_back(static_cast<std::size_t>(found - times.begin()));
  }
  kept_.push_back(candidates_.size() - 1);
}

void SparseKeys::add_candidate(const motion::Path& path, double time_s) {
  const std::size_t index = path.segment_index(time_s);
  const motion::Segment& segment = path.segments()[index];
  Side out = side_at(segment, motion::segment_parameter(segment, time_s));
  const bool is_join = index > 0 && time_s == segment.t0_s;
  Side in = is_join ? side_at(path.segments()[index - 1], 1.0) : out;
  if (!candidates_.empty()) {
    turn_towards(geometry::wxyz(candidates_.back().key.pose_W.orientation), out);
  }
  turn_towards(out.orientation, in);
  const motion::Pose pose{motion::position_at(segment, motion::segment_parameter(segment, time_s)),
                          geometry::from_wxyz(out.orientation)};
  candidates_.push_back({{time_s, pose, std::nullopt},
                         {in.velocity_m_per_s, out.velocity_m_per_s, in.orientation_rate_per_s,
                          out.orientation_rate_per_s}});
}

CameraTrack SparseKeys::interval(std::size_t begin, std::size_t end) const {
  CameraTrack track;
  track.playback = Playback::kCubic;
  for (const std::size_t i : {begin, end}) {
    track.keys.push_back(candidates_[i].key);
    track.tangents.push_back(candidates_[i].tangents);
  }
  return track;
}

std::optional<std::size_t> SparseKeys::worst_in(std::size_t begin, std::size_t end,
                                                const ThinningTolerance& tolerance) const {
  const CameraTrack played = interval(begin, end);
  std::optional<std::size_t> worst;
  double most = 1.0;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const TrackKey& key = candidates_[i].key;
    const double off = tolerances_off(key.pose_W, pose_at(played, key.time_s), tolerance);
    // Also where the spline of quaternions vanishes, and the angle is not a number.
    if (off <= most) continue;
    worst = i;
    most = off;
  }
  return worst;
}

void SparseKeys::keep_within(const ThinningTolerance& tolerance) {
  for (bool is_within = false; !is_within;) {
    std::vector<std::size_t> next = {0};
    for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
      if (const auto worst = worst_in(kept_[i], kept_[i + 1], tolerance)) next.push_back(*worst);
      next.push_back(kept_[i + 1]);
    }
    is_within = next.size() == kept_.size();
    kept_ = std::move(next);
  }
  drop_needless(tolerance);
}

void SparseKeys::mark_frames(double fps) {
  const double begin_s = candidates_.front().key.time_s;
  double frame_before = -1.0;
  for (Candidate& each : candidates_) {
    const double frames = (each.key.time_s - begin_s) * fps;
    const double frame = std::round(frames);
    // Two keys on one frame would be no frames.
    each.is_on_frame = std::abs(frames - frame) <= kOnFrame && frame > frame_before;
    if (each.is_on_frame) frame_before = frame;
  }
}

std::optional<std::size_t> SparseKeys::frame_near(std::size_t wanted, std::size_t begin,
                                                  std::size_t end) const {
  for (std::size_t off = 0; wanted - begin > off || end - wanted > off; ++off) {
    if (wanted + off < end && candidates_[wanted + off].is_on_frame) return wanted + off;
    if (wanted > begin + off && candidates_[wanted - off].is_on_frame) return wanted - off;
  }
  return std::nullopt;
}

bool SparseKeys::keep_frames_within(const ThinningTolerance& tolerance) {
  std::vector<std::size_t> before = kept_;
  std::size_t last = candidates_.size() - 1;
  while (!candidates_[last].is_on_frame) --last;  // the first one is
  if (last == 0) return false;
  std::erase_if(kept_, [&](std::size_t i) { return !candidates_[i].is_on_frame; });
  if (kept_.back() != last) kept_.push_back(last);
  for (bool is_within = false; !is_within;) {
    std::vector<std::size_t> next = {0};
    for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
      if (const auto worst = worst_in(kept_[i], kept_[i + 1], tolerance)) {
        const auto frame = frame_near(*worst, kept_[i], kept_[i + 1]);
        if (!frame) {
          kept_ = std::move(before);
          return false;
        }
        next.push_back(*frame);
      }
      next.push_back(kept_[i + 1]);
    }
    is_within = next.size() == kept_.size();
    kept_ = std::move(next);
  }
  drop_needless(tolerance);
  prefers_frames_ = true;
  return true;
}

bool SparseKeys::are_on_frames() const {
  return std::ranges::all_of(kept_, [&](std::size_t i) { return candidates_[i].is_on_frame; });
}

void SparseKeys::drop_needless(const ThinningTolerance& tolerance) {
  std::vector<std::size_t> needed = {0};
  for (std::size_t i = 1; i + 1 < kept_.size(); ++i) {
    if (worst_in(needed.back(), kept_[i + 1], tolerance)) needed.push_back(kept_[i]);
  }
  needed.push_back(kept_.back());
  kept_ = std::move(needed);
}

bool SparseKeys::add_near(double begin_s, double end_s) {
  std::vector<std::size_t> next = {0};
  for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
    const bool meets = candidates_[kept_[i]].key.time_s <= end_s &&
                       candidates_[kept_[i + 1]].key.time_s >= begin_s;
    const std::size_t middle = kept_[i] + (kept_[i + 1] - kept_[i]) / 2;
    if (meets && middle > kept_[i]) {
      const auto frame =
          prefers_frames_ ? frame_near(middle, kept_[i], kept_[i + 1]) : std::nullopt;
      next.push_back(frame.value_or(middle));
    }
    next.push_back(kept_[i + 1]);
  }
  const bool has_added = next.size() > kept_.size();
  kept_ = std::move(next);
  return has_added;
}

CameraTrack SparseKeys::track() const {
  CameraTrack track;
  track.playback = Playback::kCubic;
  for (const std::size_t i : kept_) {
    track.keys.push_back(candidates_[i].key);
    track.tangents.push_back(candidates_[i].tangents);
  }
  return track;
}

SparseKeys::Difference SparseKeys::difference(const CameraTrack& track, double offset_s) const {
  Difference largest;
  for (const Candidate& each : std::span(candidates_).first(kept_.back() + 1)) {
    const motion::Pose played = pose_at(track, each.key.time_s - offset_s);
    const motion::Pose& pose = each.key.pose_W;
    largest.position_m = std::max(largest.position_m, (pose.position - played.position).norm());
    largest.turn_rad =
        std::max(largest.turn_rad, pose.orientation.angularDistance(played.orientation));
  }
  return largest;
}

}  // namespace camway::tools
