// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/meet_limits.h"

#include <utility>
#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/stages/path_keyframes.h"
#include "daemon/planning/stages/stage_times.h"

namespace camway::planning {

namespace {

using motion::Keyframe;

// The stages that follow have to end by the deadline, too.
constexpr double kShareOfSlowing = 0.5;

std::vector<double> given_times_s(const std::vector<Keyframe>& keyframes) {
  std::vector<double> times_s;
  for (const Keyframe& keyframe : keyframes) {
    if (keyframe.origin == motion::KeyframeOrigin::kGiven) times_s.push_back(keyframe.time_s);
  }
  return times_s;
}

motion::CubicPath cubic_path(const PreparedPlan& prepared, const CorrectedPlan& corrected,
                             const std::vector<Keyframe>& keyframes) {
  if (corrected.path) return *corrected.path;
  if (corrected.is_as_interpolated) return prepared.interpolated;
  return motion::interpolate_cubic(keyframes, prepared.origin);
}

void take(Retimed slowed, const motion::TimeOrigin& origin, PlanResult& result) {
  move_times(slowed.law, result);
  result.path = slowed.path.path();
  drop_frame(result);
  for (Keyframe& keyframe : result.keyframes) {
    if (keyframe.origin != motion::KeyframeOrigin::kInserted) continue;
    keyframe.time_s = origin.nearest_s(keyframe.time_s);
    keyframe.pose = result.path.pose(keyframe.time_s);
  }
  if (slowed.check) {
    result.certificate = slowed.check->certificate;
    result.remaining_collisions = std::move(slowed.check->collisions);
  }
  const motion::PathMeasures unslowed = result.measures.value_or(motion::PathMeasures{});
  result.measures = motion::measure(result.path, slowed.interpolated.path());
  result.measures->largest_shift_rad = unslowed.largest_shift_rad;
  result.measures->mean_shift_rad = unslowed.mean_shift_rad;
}

/// Returns whether a law slows all of its path. It may do so without being uniform.
bool is_everywhere(const std::vector<SlowedStretch>& slowed, const motion::TimeLaw& law) {
  return slowed.size() == 1 && slowed.front().given_t_begin_s == law.knots_s().front() &&
         slowed.front().given_t_end_s == law.knots_s().back();
}

}  // namespace

SlowedPlan meet_limits(const collision::Query& query, const PlanRequest& request,
                       const PreparedPlan& prepared, const CorrectedPlan& corrected,
                       const base::Deadline& deadline, PlanResult& result) {
  const correction::MotionLimits& limits = request.options.limits;
  SlowedPlan plan;
  if (!limits.any()) return plan;
  plan.is_too_fast = !result.measures && limits.may_retime;  // as far as is known
  if (!result.measures) return plan;
  if (!limits.may_retime) plan.breach = find_limit_breach(result.path, limits);
  if (!limits.may_retime || meets_limits(result.path, limits)) return plan;
  const motion::CubicPath path = cubic_path(prepared, corrected, result.keyframes);
  // The policy restricts the ladder's corrections only.
  const correction::OrientationPolicy policy =
      corrected.path ? correction::without_unseen_turns(request.options.orientation)
                     : correction::OrientationPolicy{};
  const std::vector<double> times_s = given_times_s(result.keyframes);
  const bool is_free = result.certificate.certified;
  const TooFast too_fast{path,  prepared.interpolated, limits,  policy,
                         query, prepared.origin,       times_s, is_free};
  std::optional<Retimed> slowed;
  if (is_free) slowed = slowed_where_needed(too_fast, deadline.share_of_rest(kShareOfSlowing));
  if (!slowed) slowed = slowed_uniformly(too_fast, deadline.not_before_s(kLeastBudget_s));
  plan.is_too_fast = !slowed;
  if (slowed) {
    plan.law = slowed->law;
    take(std::move(*slowed), prepared.origin, result);
    plan.is_everywhere = is_everywhere(result.slowed, *plan.law);
  }
  return plan;
}

}  // namespace camway::planning
