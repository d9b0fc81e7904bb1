// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/answers.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "daemon/motion/spline/derive_times.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/plan.h"
#include "tests/bench/fidelity/same_frame.h"
#include "tests/bench/measure.h"

namespace camway::bench {

namespace {

using motion::Keyframe;
using motion::Pose;

motion::CubicPath cubic_of(const planning::PlanResult& result, const Shot& shot) {
  if (result.frame) return motion::interpolate_cubic(result.keyframes, *result.frame);
  if (result.collisions.empty()) return shot.interpolated();
  return in_frame_of(shot.interpolated(), result.path);
}

/// The poses of a straight motion at `parts` equal shares, without the first one.
void append_motion(const Pose& from, const Pose& to, int parts, std::vector<Pose>& poses) {
  for (int k = 1; k < parts; ++k) {
    const double share = static_cast<double>(k) / parts;
    const geometry::Vec3 way = to.position - from.position;
    poses.push_back({from.position + share * way, from.orientation.slerp(share, to.orientation)});
  }
  poses.push_back(to);
}

/// A spline through the waypoints of a way, with further waypoints in some intervals between
/// keyframes.
class SplineOfWay {
 public:
  SplineOfWay(const PolylineWay& way, std::span<const Keyframe> given)
      : way_(way), given_(given), parts_(given.size() - 1, 1) {}

  [[nodiscard]] std::vector<Keyframe> keyframes() const {
    std::vector<Keyframe> keyframes = {given_.front()};
    for (std::size_t leg = 0; leg < parts_.size(); ++leg) append_leg(leg, keyframes);
    return keyframes;
  }

  /// Doubles the waypoints of each interval that overlaps a collision.
  void double_where(const std::vector<collision::CollisionInterval>& collisions) {
    for (std::size_t leg = 0; leg < parts_.size(); ++leg) {
      const bool collides = std::ranges::any_of(collisions, [&](const auto& interval) {
        return interval.t_begin_s < given_[leg + 1].time_s && interval.t_end_s > given_[leg].time_s;
      });
      if (collides) parts_[leg] *= 2;
    }
  }

 private:
  void append_leg(std::size_t leg, std::vector<Keyframe>& keyframes) const {
    std::vector<Pose> poses = {given_[leg].pose};
    for (std::size_t i = way_.at_keyframe[leg]; i < way_.at_keyframe[leg + 1]; ++i) {
      append_motion(way_.poses[i], way_.poses[i + 1], parts_[leg], poses);
    }
    const std::vector<double> derived_s = motion::derive_times_s(poses);
    for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
      const double share = derived_s[i] / derived_s.back();
      const double time_s = std::lerp(given_[leg].time_s, given_[leg + 1].time_s, share);
      keyframes.push_back({time_s, poses[i], motion::KeyframeOrigin::kInserted});
    }
    keyframes.push_back(given_[leg + 1]);
  }

  const PolylineWay& way_;
  const std::span<const Keyframe> given_;
  std::vector<int> parts_;
};

/// The spline through the waypoints, which are doubled where it collides.
Answer spline_of(const Shot& shot, const PolylineWay& way, int most_doublings) {
  const std::vector<Keyframe>& given = shot.plan().keyframes;
  const double begin_s = thread_seconds();
  Answer answer;
  answer.status = "solved";
  SplineOfWay spline(way, given);
  for (int i = 0; i <= most_doublings; ++i) {
    const std::vector<Keyframe> keyframes = spline.keyframes();
    answer.path = motion::interpolate(keyframes);
    answer.inserted = keyframes.size() - given.size();
    const planning::PathCheck check = shot.check(answer.path);
    if (check.certificate.certified) {
      answer.clearance_m = check.certificate.clearance_lower_bound_m;
      break;
    }
    spline.double_where(check.collisions);
  }
  answer.time_s = thread_seconds() - begin_s;
  // Without further waypoints the spline is the path as interpolated.
  answer.cubic =
      answer.inserted == 0 ? shot.interpolated() : in_frame_of(shot.interpolated(), answer.path);
  return answer;
}

}  // namespace

Answer planned(const Shot& shot, const planning::PlanOptions& options) {
  planning::PlanRequest request = shot.plan();
  request.options = options;
  planning::PlanResult result;
  Answer answer;
  answer.time_s = warm_s([&] { result = planning::plan(shot.snapshot(), request); });
  answer.status = planning::to_string(result.status);
  if (result.path.empty()) return answer;
  answer.inserted = static_cast<std::size_t>(
      std::ranges::count(result.keyframes, motion::KeyframeOrigin::kInserted, &Keyframe::origin));
  answer.cubic = cubic_of(result, shot);
  answer.path = std::move(result.path);
  if (result.certificate.certified) {
    answer.clearance_m = result.certificate.clearance_lower_bound_m;
  }
  return answer;
}

OmplAnswers by_ompl(const Shot& shot, const OmplPeer& ompl) {
  const double deadline_s = shot.plan().options.deadline_s;
  const double begin_s = thread_seconds();
  const auto way = ompl.plan(shot.plan().keyframes, OmplPeer::Planner::kRrtConnect, deadline_s);
  const double plan_s = thread_seconds() - begin_s;
  if (!way) {
    const Answer none{.status = "gave up", .time_s = plan_s};
    return {none, none};
  }
  OmplAnswers answers{spline_of(shot, *way, 0), spline_of(shot, *way, kMostDoublings)};
  answers.spline.time_s += plan_s;
  answers.dense.time_s += plan_s;
  return answers;
}

}  // namespace camway::bench
