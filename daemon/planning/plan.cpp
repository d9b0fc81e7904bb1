// SPDX-License-Identifier: MIT
#include "daemon/planning/plan.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "daemon/collision/detect.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/planning/stages/correct.h"
#include "daemon/planning/stages/fixed_place.h"
#include "daemon/planning/stages/meet_limits.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/stages/path_outside_bounds.h"
#include "daemon/planning/stages/prepare.h"
#include "daemon/planning/stages/search_changes.h"
#include "daemon/planning/stages/sentences.h"
#include "daemon/planning/stages/set_status.h"
#include "daemon/planning/stages/shrink.h"
#include "daemon/planning/stages/stage_times.h"

namespace camway::planning {

namespace {

using base::Deadline;
using collision::CollisionInterval;

// Share of the remaining time for the search of the whole path; the rest is for its changes alone.
constexpr double kShareOfWholeSearch = 0.7;

double colliding_s(const std::vector<CollisionInterval>& intervals) {
  double sum_s = 0.0;
  for (const CollisionInterval& interval : intervals) {
    sum_s += interval.t_end_s - interval.t_begin_s;
  }
  return sum_s;
}

// The stages in order, each adding to the result. A planner has the stages after the preparation.
class Planner {
 public:
  Planner(const scene::Snapshot& snapshot, const collision::Obstacles& obstacles,
          const PlanRequest& request, const Deadline& deadline, const PreparedPlan& prepared,
          PlanResult& result)
      : snapshot_(snapshot),
        request_(request),
        deadline_(deadline),
        prepared_(prepared),
        query_{obstacles, prepared.body, detect_options(request.options)},
        result_(result) {}

  // Returns the law that slowed the path, if any.
  std::optional<motion::TimeLaw> run() {
    find_collisions();
    if (is_searched_ && !result_.collisions.empty()) {
      corrected_ = correct(snapshot_, query_, request_, prepared_, deadline_, result_);
      result_.timing.correct_ms = lap_ms();
    }
    certify();
    keep_the_better_path();
    measure();
    slow();
    add_clearance();
    add_clearance_profile();
    const std::optional<FixedPlace> limit = limit_of_safest();
    set_status({request_, query_, prepared_.origin, corrected_, slowed_, is_searched_, limit},
               result_);
    return std::move(slowed_.law);
  }

 private:
  // Finds the collisions of the path as interpolated.
  void find_collisions() {
    deadline_.report(base::Progress::Stage::kDetecting);
    std::optional<std::vector<CollisionInterval>> found = collision::detect_collisions(
        query_, result_.path, result_.path.begin_s(), result_.path.end_s(), deadline_);
    is_searched_ = found.has_value();
    if (found) result_.collisions = std::move(*found);
    deadline_.report_collisions(result_.collisions.size(), 0);
    result_.timing.detect_ms = lap_ms();
    if (is_searched_) return;
    // Nothing is known of the path, so all of it counts as colliding.
    result_.remaining_collisions = {{result_.path.begin_s(), result_.path.end_s()}};
    corrected_.timed_out = true;
  }

  // The final check of the path as it will be returned, which also runs when correction ran out of
  // time: an answer without it would be worth nothing.
  void certify() {
    if (result_.path.empty() || !is_searched_) return;
    deadline_.report(base::Progress::Stage::kCertifying);
    const Deadline budget = deadline_.sooner_by_s(rest_s()).not_before_s(kLeastBudget_s);
    // As interpolated, these very segments were searched already.
    result_.remaining_collisions =
        corrected_.is_as_interpolated ? result_.collisions : final_search(budget);
    if (result_.remaining_collisions.empty()) {
      result_.certificate = certificate_of_free(query_, result_.path, budget);
    }
    result_.timing.certify_ms = lap_ms();
  }

  // Searches the whole path or, if there is no time for that, only what was changed.
  std::vector<CollisionInterval> final_search(const Deadline& budget) {
    collision::FoundCollisions whole{false, {}, result_.path.begin_s()};
    if (!corrected_.timed_out) {
      whole = collision::search_collisions(query_, result_.path, result_.path.begin_s(),
                                           result_.path.end_s(),
                                           budget.share_of_rest(kShareOfWholeSearch));
    }
    if (whole.complete) {
      collision::remove_undecided(query_, result_.path, budget, whole.collisions);
      return std::move(whole.collisions);
    }
    corrected_.timed_out = true;
    // Keyframe insertion changes the path everywhere.
    const motion::Path before = corrected_.path ? prepared_.interpolated.path() : motion::Path();
    collision::FoundCollisions changes =
        search_changes(query_, result_.path, {before, result_.collisions}, whole, budget);
    if (!changes.complete) give_up_corrections(changes.until_s);
    return std::move(changes.collisions);
  }

  // Drops the corrections from `from_s` on, which there was no time to check.
  void give_up_corrections(double from_s) {
    put_back(from_s, request_, prepared_, corrected_, result_);
    for (correction::Correction& correction : result_.corrections) {
      if (correction.interval.t_end_s > from_s) correction = {correction.interval};
    }
  }

  // Corrections of some intervals can bend the spline into others. If they lengthened the total
  // time in collision, returns to the path as interpolated.
  void keep_the_better_path() {
    if (colliding_s(result_.remaining_collisions) <= colliding_s(result_.collisions)) return;
    if (result_.collisions.empty()) return;
    put_back(result_.path.begin_s(), request_, prepared_, corrected_, result_);
    result_.remaining_collisions = result_.collisions;
  }

  void measure() {
    if (result_.path.empty()) return;
    if (!is_searched_ && leaves_too_little(deadline_, rest_s())) return;
    const motion::Path before = prepared_.interpolated.path();
    result_.measures_before = motion::measure(before, before);
    if (result_.collisions.empty()) {
      result_.measures_before->clearance_lower_bound_m =
          result_.certificate.clearance_lower_bound_m;
    }
    result_.measures = corrected_.is_as_interpolated ? result_.measures_before
                                                     : motion::measure(result_.path, before);
    if (corrected_.path) {
      const correction::Shift shift =
          correction::shift_of(*corrected_.path, prepared_.interpolated, corrected_.closeness);
      result_.measures->largest_shift_rad = shift.largest_rad;
      result_.measures->mean_shift_rad = shift.mean_rad;
      result_.viewing_distance_m = corrected_.closeness.viewing_distance_m;
    }
  }

  void slow() {
    slowed_ = meet_limits(query_, request_, prepared_, corrected_, deadline_, result_);
    result_.timing.certify_ms += lap_ms();
  }

  // Called last, since corrections and retiming both change the path and its proof.
  void add_clearance() {
    if (result_.measures) {
      result_.measures->clearance_lower_bound_m = result_.certificate.clearance_lower_bound_m;
    }
  }

  // The profile is of the path as it will be returned, whatever changed it.
  void add_clearance_profile() {
    if (!request_.options.clearance_profile || result_.path.empty()) return;
    result_.clearance_profile = collision::clearance_profile(
        query_, result_.path, result_.remaining_collisions,
        result_.certificate.clearance_lower_bound_m, deadline_.not_before_s(kLeastBudget_s));
    result_.timing.certify_ms += lap_ms();
  }

  // Finds what keeps the safest path from more room. A slowed path has other times than its
  // corrections.
  std::optional<FixedPlace> limit_of_safest() {
    const bool is_safest = request_.options.objective == correction::Objective::kSafest;
    if (!is_safest || !corrected_.path || !result_.certificate.certified || slowed_.law) return {};
    const double comfort_m = correction::kComfort * correction::FreeSpace(query_).ball_radius_m();
    const double gap_m = result_.certificate.clearance_lower_bound_m - request_.options.clearance_m;
    if (gap_m >= comfort_m) return {};
    std::optional<FixedPlace> place = limiting_place(query_, result_, deadline_);
    result_.timing.certify_ms += lap_ms();
    return place;
  }

  // Time for the stages after the final check.
  [[nodiscard]] double rest_s() const {
    return rest_s_per_piece(request_.options) * static_cast<double>(result_.path.segments().size());
  }

  double lap_ms() {
    const double now_ms = deadline_.elapsed_ms();
    return now_ms - std::exchange(lap_begin_ms_, now_ms);
  }

  const scene::Snapshot& snapshot_;
  const PlanRequest& request_;
  const Deadline& deadline_;
  const PreparedPlan& prepared_;
  const collision::Query query_;
  double lap_begin_ms_ = deadline_.elapsed_ms();
  bool is_searched_ = false;  ///< the path as interpolated was searched for collisions
  CorrectedPlan corrected_;
  SlowedPlan slowed_;
  PlanResult& result_;
};

UnsentResult plan_at_size(const scene::Snapshot& snapshot, const collision::Obstacles& obstacles,
                          const PlanRequest& request, const Deadline& deadline) {
  const double started_ms = deadline.elapsed_ms();
  UnsentResult unsent;
  PlanResult& result = unsent.result;
  const std::optional<PreparedPlan> prepared =
      prepare(snapshot, obstacles, request, deadline, result);
  if (prepared) {
    result.timing.motion_ms = deadline.elapsed_ms() - started_ms;
    unsent.origin = prepared->origin;
    unsent.law = Planner(snapshot, obstacles, request, deadline, *prepared, result).run();
  }
  result.timing.total_ms = deadline.elapsed_ms() - started_ms;
  return unsent;
}

PlanResult plan_among(const scene::Snapshot& snapshot, const collision::Obstacles& obstacles,
                      const PlanRequest& request, const Deadline& deadline) {
  const auto plan = [&](const PlanRequest& asked, const Deadline& until) {
    return plan_at_size(snapshot, obstacles, asked, until);
  };
  return with_sent_times(may_shrink(request) ? plan_with_shrinking(request, deadline, plan)
                                             : plan(request, deadline));
}

}  // namespace

PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request,
                const Deadline& deadline) {
  try {
    const collision::Obstacles scene(snapshot);
    const collision::Obstacles bounded = scene.within(request.options.bounds);
    PlanResult result =
        plan_among(snapshot, bounded, request,
                   bounded.bounds.any() ? deadline.share_of_rest(kShareWithinBounds) : deadline);
    if (may_have_path_outside_bounds(request, result) && !deadline.passed()) {
      add_path_outside_bounds(plan_among(snapshot, scene.without_bounds(), request, deadline),
                              scene.without_bounds(), request, result);
    }
    result.deadline_reached = deadline.struck();
    if (result.deadline_reached && result.status == Status::kOk) {
      result.message += "; " + deadline_text(request) +
                        (result.collisions.empty() ? " before its clearance was measured"
                                                   : " before it was improved to the end");
    }
    return result;
  } catch (const std::exception& error) {
    // Out of memory, or a mistake of ours: either must not take the caller's process with it.
    PlanResult result;
    result.status = Status::kInternalError;
    result.message = fmt::format("internal error: {}", error.what());
    return result;
  }
}

PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request) {
  return plan(snapshot, request, Deadline::after_s(request.options.deadline_s));
}

}  // namespace camway::planning
