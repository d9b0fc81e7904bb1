// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/keyframe_times.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "daemon/motion/spline/derive_times.h"

namespace camway::planning {

namespace {

using collision::CollisionInterval;
using motion::Keyframe;
using motion::Segment;
using motion::TimeOrigin;

void to_sent_times(const TimeOrigin& origin, CollisionInterval& interval) {
  interval.t_begin_s = origin.sent_not_after_s(interval.t_begin_s);
  interval.t_end_s = origin.sent_not_before_s(interval.t_end_s);
  if (interval.witness) interval.witness->time_s = origin.sent_s(interval.witness->time_s);
}

}  // namespace

PreparedKeyframes prepared_keyframes(const PlanRequest& request) {
  PreparedKeyframes prepared{request.keyframes, {}};
  std::vector<motion::Pose> poses;
  poses.reserve(prepared.keyframes.size());
  for (Keyframe& keyframe : prepared.keyframes) {
    keyframe.pose.orientation.normalize();
    keyframe.origin = motion::KeyframeOrigin::kGiven;
    keyframe.is_repaired = false;
    poses.push_back(keyframe.pose);
  }
  if (request.has_times) {
    prepared.origin =
        TimeOrigin::of(request.keyframes.front().time_s, request.keyframes.back().time_s);
    for (Keyframe& keyframe : prepared.keyframes)
      keyframe.time_s = prepared.origin.local_s(keyframe.time_s);
    return prepared;
  }
  const std::vector<double> times_s = motion::derive_times_s(
      poses, request.options.default_speed_m_per_s.value_or(motion::kNominalSpeed_m_per_s));
  for (std::size_t i = 0; i < times_s.size(); ++i) prepared.keyframes[i].time_s = times_s[i];
  return prepared;
}

motion::Path to_sent_times(const TimeOrigin& origin, const motion::Path& path) {
  std::vector<Segment> segments(path.segments().begin(), path.segments().end());
  for (Segment& segment : segments) {
    segment.t0_s = origin.sent_s(segment.t0_s);
    segment.t1_s = origin.sent_s(segment.t1_s);
  }
  return motion::Path(std::move(segments));
}

void to_sent_times(const TimeOrigin& origin, PlanResult& result) {
  if (origin.s == 0.0) return;
  const auto move = [&](double& time_s) { time_s = origin.sent_s(time_s); };
  result.path = to_sent_times(origin, result.path);
  for (Keyframe& keyframe : result.keyframes) move(keyframe.time_s);
  for (CollisionInterval& interval : result.collisions) to_sent_times(origin, interval);
  for (CollisionInterval& interval : result.remaining_collisions) to_sent_times(origin, interval);
  for (correction::Correction& correction : result.corrections) {
    to_sent_times(origin, correction.interval);
    move(correction.t_begin_s);
    move(correction.t_end_s);
  }
  collision::move_times({[&](double time_s) { return origin.sent_s(time_s); },
                         [&](double time_s) { return origin.sent_not_after_s(time_s); },
                         [&](double time_s) { return origin.sent_not_before_s(time_s); }},
                        result.clearance_profile);
  for (SlowedStretch& stretch : result.slowed) {
    for (double* time_s :
         {&stretch.t_begin_s, &stretch.t_end_s, &stretch.given_t_begin_s, &stretch.given_t_end_s}) {
      move(*time_s);
    }
  }
}

std::string time_text(double time_s) {
  return std::abs(time_s) < 100.0 ? fmt::format("{:.5g}", time_s) : fmt::format("{:.3f}", time_s);
}

}  // namespace camway::planning
