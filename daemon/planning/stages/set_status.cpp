// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/set_status.h"

#include <fmt/format.h>

#include <string>

#include "daemon/planning/stages/keyframe_times.h"
#include "daemon/planning/stages/sentences.h"

namespace camway::planning {
namespace {

/// Returns the notes about the request and the scene.
std::string notes(const Outcomes& plan, const PlanResult& result) {
  return note_of_scale(result, plan.query.obstacles.index.bounds()) + note_of_tilt(plan.request) +
         note_of_tolerance(plan.request, plan.query.body) + note_of_method(plan.request);
}

/// Returns ", 0.12 m or more from the scene", rounded down; nothing where there was no time to find
/// out.
std::string note_of_clearance(double clearance_m) {
  return clearance_m > 0.0 ? fmt::format(", {} m or more from the scene", rounded_down(clearance_m))
                           : "";
}

/// How the path would be if it were better by the objective than the closest one.
const char* better_by(correction::Objective objective) {
  switch (objective) {
    case correction::Objective::kShortest:
      return "is shorter";
    case correction::Objective::kSmoothest:
      return "is smoother";
    case correction::Objective::kSafest:
      return "keeps more room";
    case correction::Objective::kClosest:
      break;
  }
  return nullptr;
}

/// Says that the path is the closest one, where the request asks for another and none was found.
std::string note_of_objective(const PlanRequest& request, const CorrectedPlan& corrected) {
  const char* better = better_by(request.options.objective);
  if (better == nullptr || !corrected.path || corrected.is_polished) return {};
  const std::int32_t limit = request.options.max_inserted_keyframes;
  const std::string within =
      limit < PlanOptions().max_inserted_keyframes
          ? fmt::format(" with at most {}",
                        counted(static_cast<std::size_t>(limit), "inserted keyframe"))
          : "";
  return fmt::format("; none{} was found that {} than the closest one", within, better);
}

/// Says why the path keeps no more room, where that is known.
std::string note_of_limit(const Outcomes& plan) {
  if (!plan.limit) return {};
  if (plan.limit->keyframe) {
    return fmt::format("; no path keeps more than the {:.3g} m of keyframe {}, which stays",
                       plan.limit->distance_m, *plan.limit->keyframe);
  }
  return fmt::format("; the path is nearest to the scene at {} s, where no correction changes it",
                     time_text(plan.origin.sent_s(plan.limit->time_s)));
}

void set_status_of_free(const Outcomes& plan, PlanResult& result) {
  if (plan.slowed.breach) {
    // It is proved free, and the certificate says so; it is not what was asked for.
    result.status = Status::kPartial;
    result.message = why_too_fast(plan.request, *plan.slowed.breach, plan.origin);
  } else if (plan.slowed.is_too_fast) {
    result.status = Status::kTimeout;
    result.message = plan.request.name_of("options.limits") +
                     ": the path is free, but too fast, and " + deadline_text(plan.request) +
                     " before it was slowed";
  } else {
    result.status = Status::kOk;
    result.message =
        fmt::format("{}; the path is proved free of collision{}{}", what_was_done(result),
                    note_of_clearance(result.certificate.clearance_lower_bound_m),
                    plan.query.obstacles.bounds.any() ? ", and within bounds" : "") +
        note_of_objective(plan.request, plan.corrected) + note_of_limit(plan) +
        note_of_times(result, plan.slowed.is_everywhere) + notes(plan, result);
  }
}

void set_status_of_colliding(const Outcomes& plan, PlanResult& result) {
  result.status = plan.corrected.timed_out ? Status::kTimeout : Status::kPartial;
  // Names what the deadline left undone.
  const std::string haste = plan.slowed.is_too_fast ? "; it was not slowed to meet " +
                                                          plan.request.name_of("options.limits")
                                                    : "";
  if (!plan.is_searched) {
    result.message = deadline_text(plan.request) +
                     " before the path was searched for collisions: nothing is known of it" +
                     haste + notes(plan, result);
    return;
  }
  if (!result.shut_in.empty()) result.keyframe = result.shut_in.front().keyframe;
  result.message =
      fmt::format("{}the path still collides {} ({})",
                  plan.corrected.timed_out ? deadline_text(plan.request) + "; " : "",
                  counted(result.remaining_collisions.size(), "time"), what_was_done(result)) +
      note_of_shut_in(result.shut_in, plan.query.obstacles.bounds.any()) +
      note_of_keyframe_limit(plan.request, result, plan.corrected.needed_keyframes) +
      note_of_effort(result.corrections) + haste +
      note_of_times(result, plan.slowed.is_everywhere) + notes(plan, result);
}

}  // namespace

void set_status(const Outcomes& plan, PlanResult& result) {
  if (result.remaining_collisions.empty()) {
    set_status_of_free(plan, result);
  } else if (result.infeasibility) {
    result.status = Status::kInfeasible;
    result.message =
        why_infeasible(*result.infeasibility, may_shrink(plan.request)) + notes(plan, result);
  } else {
    set_status_of_colliding(plan, result);
  }
}

}  // namespace camway::planning
