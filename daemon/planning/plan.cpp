// SPDX-License-Identifier: MIT
#include "daemon/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/correction/ladder/ladder.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/paper/keyframe_insertion.h"
#include "daemon/planning/check.h"
#include "daemon/planning/effort_text.h"
#include "daemon/planning/keyframe_faults.h"
#include "daemon/planning/keyframe_times.h"
#include "daemon/planning/limits.h"
#include "daemon/planning/search_changes.h"
#include "daemon/planning/shrink.h"
#include "daemon/planning/way_beyond.h"

namespace camway::planning {

namespace {

using base::Deadline;
using collision::CollisionInterval;
using motion::Keyframe;

double colliding_s(const std::vector<CollisionInterval>& intervals) {
  double sum_s = 0.0;
  for (const CollisionInterval& interval : intervals)
    sum_s += interval.t_end_s - interval.t_begin_s;
  return sum_s;
}

// The stages in order, each adding to the result.
class Planner {
 public:
  Planner(const scene::Snapshot& snapshot, const collision::Obstacles& obstacles,
          const PlanRequest& request, const Deadline& deadline)
      : snapshot_(snapshot),
        obstacles_(obstacles),
        request_(request),
        deadline_(deadline),
        detect_(detect_options(request.options)) {}

  UnsentResult run() && {
    if (prepare()) {
      correct(find_collisions());
      certify();
      keep_the_better_path();
      measure();
      meet_limits();
      add_clearance();
      conclude();
    }
    result_.timing.total_ms = deadline_.elapsed_ms() - started_ms_;
    return {std::move(result_), origin_, std::move(law_)};
  }

 private:
  // Motion through the keyframes; false if the request cannot be planned.
  bool prepare() {
    deadline_.report(base::Progress::Stage::kPreparing);
    if (std::optional<InvalidRequest> fault = validate(request_)) {
      refuse(std::move(fault->message), fault->keyframe);
      return false;
    }
    result_.bounds = obstacles_.bounds;
    if (geometry::fault_in(obstacles_.bounds)) {
      refuse(request_.name_of("options.bounds") + ": leave no room within the bounds of the scene",
             std::nullopt);
      return false;
    }
    std::string fault;
    body_ = motion::Body::make(request_.body.value_or(request_.camera), fault);
    if (!body_) {
      refuse("body: " + fault, std::nullopt);
      return false;
    }
    PreparedKeyframes prepared = prepared_keyframes(request_);
    result_.keyframes = std::move(prepared.keyframes);
    origin_ = prepared.origin;
    if (!keyframes_are_free()) return false;
    if (leaves_too_little(kInterpolating_s_per_keyframe *
                          static_cast<double>(result_.keyframes.size()))) {
      give_up("the path was interpolated");
      return false;
    }
    interpolated_ = motion::interpolate_cubic(result_.keyframes, origin_);
    result_.path = interpolated_.path();
    result_.timing.motion_ms = lap_ms();
    return true;
  }

  // Repairs keyframes that are not free, if the request asks for that. Returns false if the request
  // cannot be planned, or not in time.
  bool keyframes_are_free() {
    KeyframeFaults found =
        find_keyframe_faults(snapshot_, obstacles_, *body_, detect_, result_.keyframes, deadline_);
    result_.keyframe_faults = std::move(found.faults);
    const std::vector<KeyframeFault>& faults = result_.keyframe_faults;
    const bool all_free = std::ranges::all_of(
        faults, [](const KeyframeFault& fault) { return fault.free_pose.has_value(); });
    if (!faults.empty() &&
        !(request_.options.repair_keyframes && all_free && faults.size() < kMostKeyframeFaults)) {
      refuse_keyframes();
      return false;
    }
    for (const KeyframeFault& fault : faults) {
      result_.keyframes[fault.keyframe].pose = *fault.free_pose;
      result_.keyframes[fault.keyframe].is_repaired = true;
    }
    if (!found.complete) give_up("all keyframes were looked at");
    return found.complete;
  }

  void refuse_keyframes() {
    const std::vector<KeyframeFault>& faults = result_.keyframe_faults;
    const KeyframeFault& first = fault_to_name(faults, request_);
    refuse(why_refused(faults, request_, deadline_.passed()), first.keyframe);
  }

  // Returns the collisions of the path as interpolated; nothing if the deadline struck.
  std::optional<std::vector<CollisionInterval>> find_collisions() {
    deadline_.report(base::Progress::Stage::kDetecting);
    std::optional<std::vector<CollisionInterval>> found = detect();
    if (found) result_.collisions = *found;
    deadline_.report_collisions(result_.collisions.size(), 0);
    result_.timing.detect_ms = lap_ms();
    return found;
  }

  void correct(const std::optional<std::vector<CollisionInterval>>& found) {
    if (!found) {
      timed_out_ = true;
      is_searched_ = false;
      mark_all_as_remaining();
      return;
    }
    if (found->empty()) return;
    deadline_.report(base::Progress::Stage::kCorrecting);
    if (request_.options.method == Method::kLadder) {
      correct_by_ladder(*found);
    } else if (body_->is_camera()) {
      // The paper's method handles near quadrilaterals only, and no clearance.
      insert_keyframes();
    }
    result_.timing.correct_ms = lap_ms();
  }

  void correct_by_ladder(const std::vector<CollisionInterval>& found) {
    correction::LadderOptions options;
    options.detect = detect_;
    options.origin = origin_;
    options.max_inserted_keyframes = request_.options.max_inserted_keyframes;
    options.seed = request_.options.seed;
    options.objective = request_.options.objective;
    options.orientation = request_.options.orientation;
    options.max_shrink = may_shrink(request_) ? request_.options.max_shrink : 0.0;
    options.rest_s_per_piece = kSearching_s_per_piece + rest_s_per_piece();
    correction::LadderResult corrected = correction::correct_by_ladder(
        snapshot_.mesh, obstacles_, *body_, result_.keyframes, interpolated_, found, options,
        deadline_.share_of_rest(kShareOfCorrection));
    timed_out_ = corrected.timed_out;
    needed_keyframes_ = corrected.needed_keyframes;
    result_.shut_in = std::move(corrected.shut_in);
    result_.corrections = std::move(corrected.corrections);
    if (corrected.separation) {
      result_.infeasibility =
          Infeasibility{corrected.separation->inside, corrected.separation->outside,
                        std::move(corrected.separation->triangles)};
    } else if (corrected.cage) {
      result_.infeasibility =
          Infeasibility{corrected.cage->inside, corrected.cage->outside,
                        std::move(corrected.cage->triangles), corrected.cage->box};
    }
    // Corrections of less than the tolerance insert no keyframes, and are corrections.
    const bool any = std::ranges::any_of(result_.corrections, [](const auto& correction) {
      return correction.rung != correction::Rung::kNone;
    });
    if (!any) return;
    is_as_interpolated_ = false;
    corrected_ = std::move(corrected.path);
    result_.path = corrected_->path();
    for (const double time_s : corrected.inserted_s) {
      result_.keyframes.push_back(
          {time_s, result_.path.pose(time_s), motion::KeyframeOrigin::kInserted});
    }
    std::ranges::stable_sort(result_.keyframes, {}, &Keyframe::time_s);
  }

  void insert_keyframes() {
    paper::KeyframeInsertionOptions options;
    options.sweep = {request_.options.chord_error_m, detect_};
    options.origin = origin_;
    options.max_inserted_keyframes = request_.options.max_inserted_keyframes;
    paper::KeyframeInsertionResult corrected = paper::insert_keyframes(
        obstacles_.index, result_.keyframes, motion::near_corners_C(request_.camera), options,
        deadline_.share_of_rest(kShareOfCorrection).sooner_by_s(rest_s()));
    is_as_interpolated_ = false;
    result_.keyframes = std::move(corrected.keyframes);
    result_.path = std::move(corrected.path);
    timed_out_ = corrected.timed_out;
  }

  // Time for the stages after the final check: for each piece of the path, and in all.
  [[nodiscard]] double rest_s_per_piece() const {
    return kMeasuring_s_per_piece + (request_.options.limits.any() ? kSlowing_s_per_piece : 0.0);
  }
  [[nodiscard]] double rest_s() const {
    return rest_s_per_piece() * static_cast<double>(result_.path.segments().size());
  }

  // The final check of the path as it will be returned, which also runs when correction ran out of
  // time: an answer without it would be worth nothing.
  void certify() {
    if (result_.path.empty() || !result_.remaining_collisions.empty()) return;
    deadline_.report(base::Progress::Stage::kCertifying);
    const Deadline budget = deadline_.sooner_by_s(rest_s()).not_before_s(kLeastBudget_s);
    // As interpolated, these very segments were searched already.
    result_.remaining_collisions = is_as_interpolated_ ? result_.collisions : final_search(budget);
    if (result_.remaining_collisions.empty()) {
      result_.certificate = certificate_of_free(obstacles_, result_.path, *body_, detect_, budget);
    }
    result_.timing.certify_ms = lap_ms();
  }

  // Searches the whole path or, if there is no time for that, only what was changed.
  std::vector<CollisionInterval> final_search(const Deadline& budget) {
    collision::Search whole{false, {}, result_.path.begin_s()};
    if (!timed_out_) {
      whole = collision::search_collisions(obstacles_, result_.path, *body_, result_.path.begin_s(),
                                           result_.path.end_s(), detect_,
                                           budget.share_of_rest(kShareOfWholeSearch));
    }
    if (whole.complete) return std::move(whole.collisions);
    timed_out_ = true;
    // Keyframe insertion changes the path everywhere.
    const motion::Path before = corrected_ ? interpolated_.path() : motion::Path();
    collision::Search changes = search_changes(obstacles_, result_.path, *body_, detect_,
                                               {before, result_.collisions}, whole, budget);
    if (!changes.complete) give_up_corrections(changes.until_s);
    return std::move(changes.collisions);
  }

  // Drops the corrections from `from_s` on, which there was no time to check.
  void give_up_corrections(double from_s) {
    put_back(from_s);
    for (correction::Correction& correction : result_.corrections) {
      if (correction.interval.t_end_s > from_s) correction = {correction.interval};
    }
  }

  // Restores the path as interpolated, whose collisions are known, from `from_s` on.
  void put_back(double from_s) {
    std::erase_if(result_.keyframes, [&](const Keyframe& keyframe) {
      return keyframe.origin == motion::KeyframeOrigin::kInserted && keyframe.time_s >= from_s;
    });
    is_as_interpolated_ = from_s <= interpolated_.begin_s();
    if (is_as_interpolated_) {
      corrected_.reset();
    } else {
      corrected_ = with_rest_of(*corrected_, interpolated_, from_s);
    }
    result_.path = (corrected_ ? *corrected_ : interpolated_).path();
  }

  // Corrections of some intervals can bend the spline into others. If they lengthened the total
  // time in collision, returns to the path as interpolated.
  void keep_the_better_path() {
    if (colliding_s(result_.remaining_collisions) <= colliding_s(result_.collisions)) return;
    if (result_.collisions.empty()) return;
    put_back(result_.path.begin_s());
    result_.remaining_collisions = result_.collisions;
  }

  void measure() {
    if (result_.path.empty() || (!is_searched_ && leaves_too_little(rest_s()))) return;
    const motion::Path before = interpolated_.path();
    result_.measures_before = motion::measure(before, before);
    if (result_.collisions.empty()) {
      result_.measures_before->clearance_lower_bound_m =
          result_.certificate.clearance_lower_bound_m;
    }
    result_.measures =
        is_as_interpolated_ ? result_.measures_before : motion::measure(result_.path, before);
  }

  // Called last, since corrections and retiming both change the path and its proof.
  void add_clearance() {
    if (result_.measures) {
      result_.measures->clearance_lower_bound_m = result_.certificate.clearance_lower_bound_m;
    }
  }

  // Slows the path where it exceeds the motion limits. A path that collides is not worth a new
  // curve: it is slowed all the way, which leaves its collisions where they are.
  void meet_limits() {
    const correction::MotionLimits& limits = request_.options.limits;
    if (!limits.any()) return;
    is_too_fast_ = !result_.measures && limits.may_retime;  // as far as is known
    if (!result_.measures) return;
    if (!limits.may_retime) breach_ = find_limit_breach(result_.path, limits);
    if (!limits.may_retime || meets_limits(result_.path, limits)) return;
    const motion::CubicPath path = corrected_ ? *corrected_
                                   : is_as_interpolated_
                                       ? interpolated_
                                       : motion::interpolate_cubic(result_.keyframes, origin_);
    // The policy restricts the ladder's corrections only.
    const correction::OrientationPolicy policy =
        corrected_ ? request_.options.orientation : correction::OrientationPolicy{};
    const std::vector<double> times_s = given_times_s();
    const bool is_free = result_.certificate.certified;
    const TooFast too_fast{path,   interpolated_, limits,  policy,  obstacles_,
                           *body_, detect_,       origin_, times_s, is_free};
    std::optional<Retimed> slowed;
    if (is_free) {
      slowed = slowed_where_needed(too_fast, deadline_.share_of_rest(kShareOfSlowing));
    }
    slowed_everywhere_ = !slowed;
    if (!slowed) slowed = slowed_alike(too_fast, deadline_.not_before_s(kLeastBudget_s));
    is_too_fast_ = !slowed;
    if (slowed) take(std::move(*slowed));
    result_.timing.certify_ms += lap_ms();
  }

  [[nodiscard]] std::vector<double> given_times_s() const {
    std::vector<double> times_s;
    for (const Keyframe& keyframe : result_.keyframes) {
      if (keyframe.origin == motion::KeyframeOrigin::kGiven) times_s.push_back(keyframe.time_s);
    }
    return times_s;
  }

  void take(Retimed slowed) {
    move_times(slowed.law, result_);
    result_.path = slowed.path.path();
    for (Keyframe& keyframe : result_.keyframes) {
      if (keyframe.origin != motion::KeyframeOrigin::kInserted) continue;
      keyframe.time_s = origin_.nearest_s(keyframe.time_s);
      keyframe.pose = result_.path.pose(keyframe.time_s);
    }
    if (slowed.check) {
      result_.certificate = slowed.check->certificate;
      result_.remaining_collisions = std::move(slowed.check->collisions);
    }
    result_.measures = motion::measure(result_.path, slowed.interpolated.path());
    law_ = std::move(slowed.law);
  }

  [[nodiscard]] std::string note() const {
    return note_of_bounds() + note_of_tilt(request_) + note_of_tolerance() +
           note_of_method(request_);
  }

  // A gap that the tolerance cannot tell from a collision counts as one. For a tiny body that can
  // be every opening that it fits through.
  [[nodiscard]] std::string note_of_tolerance() const {
    const double size_m = 2.0 * correction::FreeSpace(obstacles_, *body_, detect_).ball_radius_m();
    if (!(size_m < kLeastTolerances * detect_.tolerance_m)) return {};
    return fmt::format("; note: the body is {:.2g} m large, and {} of {:.2g} m is coarse for that",
                       size_m, request_.name_of("options.interval_tolerance_m"),
                       detect_.tolerance_m);
  }

  // Keyframes beyond the scene are fine for a flight around an object. More often the unit or the
  // axes of the file are not what was assumed, and then everything looks free.
  [[nodiscard]] std::string note_of_bounds() const {
    const bool inside = std::ranges::any_of(result_.keyframes, [&](const Keyframe& keyframe) {
      return obstacles_.index.bounds().contains(keyframe.pose.position);
    });
    if (inside || obstacles_.index.bounds().isEmpty()) return {};
    return "; note: no keyframe lies within the bounds of the scene, check its scale and axes";
  }

  [[nodiscard]] std::size_t inserted_keyframes() const {
    return static_cast<std::size_t>(std::ranges::count(
        result_.keyframes, motion::KeyframeOrigin::kInserted, &Keyframe::origin));
  }

  void conclude() {
    const std::size_t remaining = result_.remaining_collisions.size();
    if (remaining == 0 && breach_) {
      // It is proved free, and the certificate says so; it is not what was asked for.
      result_.status = Status::kPartial;
      result_.message = why_too_fast();
      return;
    }
    if (remaining == 0 && is_too_fast_) {
      result_.status = Status::kTimeout;
      result_.message = request_.name_of("options.limits") +
                        ": the path is free, but too fast, and the deadline came before it was "
                        "slowed";
      return;
    }
    if (remaining == 0) {
      result_.status = Status::kOk;
      result_.message =
          fmt::format("{}; the path is proved free of collision, {} m or more from the scene{}",
                      what_was_done(), rounded_down(result_.certificate.clearance_lower_bound_m),
                      obstacles_.bounds.any() ? ", and within bounds" : "") +
          note_of_times() + note();
      return;
    }
    if (result_.infeasibility) {
      result_.status = Status::kInfeasible;
      result_.message = why_infeasible(*result_.infeasibility, may_shrink(request_)) + note();
      return;
    }
    result_.status = timed_out_ ? Status::kTimeout : Status::kPartial;
    if (!is_searched_) {
      result_.message =
          "the deadline came before the path was searched for collisions: nothing is known of it" +
          note_of_haste() + note();
      return;
    }
    if (!result_.shut_in.empty()) result_.keyframe = result_.shut_in.front().keyframe;
    result_.message = fmt::format("{}the path still collides {} ({})",
                                  timed_out_ ? "the deadline came first; " : "",
                                  counted(remaining, "time"), what_was_done()) +
                      note_of_shut_in(result_.shut_in, obstacles_.bounds.any()) +
                      note_of_keyframe_limit() + note_of_effort(result_.corrections) +
                      note_of_haste() + note_of_times() + note();
  }

  // Names what the deadline left undone.
  [[nodiscard]] std::string note_of_haste() const {
    return is_too_fast_ ? "; it was not slowed to meet " + request_.name_of("options.limits") : "";
  }

  [[nodiscard]] std::string note_of_keyframe_limit() const {
    const std::int32_t most = request_.options.max_inserted_keyframes;
    if (result_.collisions.empty()) return {};
    const std::string field = request_.name_of("options.max_inserted_keyframes");
    if (most == 0) return fmt::format("; nothing was corrected, as {} asks for", field);
    // Keyframe insertion does not report how many keyframes it needs.
    const bool is_used_up = std::cmp_greater_equal(inserted_keyframes(), most);
    if (!needed_keyframes_ && !is_used_up) return {};
    if (!needed_keyframes_) return fmt::format("; {} allows {}", field, most);
    return fmt::format("; {} allows {}, the corrections that were found need {}", field, most,
                       *needed_keyframes_);
  }

  // "3 collisions at first, 12 keyframes inserted": numbers that are 0 are left out.
  [[nodiscard]] std::string what_was_done() const {
    std::string text = result_.collisions.empty()
                           ? "no collision to correct"
                           : counted(result_.collisions.size(), "collision") + " at first";
    const std::size_t inserted = inserted_keyframes();
    if (inserted > 0) text += fmt::format(", {} inserted", counted(inserted, "keyframe"));
    const std::size_t repaired = result_.keyframe_faults.size();
    if (repaired > 0) text += fmt::format(", {} repaired", counted(repaired, "keyframe"));
    return text;
  }

  [[nodiscard]] std::string why_too_fast() const {
    return fmt::format(
        "{}: the path is free, but too fast from {} s to {} s{}: {}; allow {}, or give later "
        "times",
        request_.name_of("options.limits"), time_text(origin_.sent_s(breach_->t_begin_s)),
        time_text(origin_.sent_s(breach_->t_end_s)),
        breach_->stretches > 1
            ? fmt::format(" and at {}", counted(breach_->stretches - 1, "other time"))
            : "",
        breach_->rate, request_.name_of("options.limits.retime"));
  }

  [[nodiscard]] std::string note_of_times() const {
    if (result_.time_scale == 1.0) return {};
    return fmt::format("; slowed {} to meet the limits, {:.4g} times as long",
                       slowed_everywhere_ ? "all the way" : "in part", result_.time_scale);
  }

  std::optional<std::vector<CollisionInterval>> detect() const {
    return collision::detect_collisions(obstacles_, result_.path, *body_, result_.path.begin_s(),
                                        result_.path.end_s(), detect_, deadline_);
  }

  // Nothing is known of the path, so all of it counts as colliding.
  void mark_all_as_remaining() {
    result_.remaining_collisions = {{result_.path.begin_s(), result_.path.end_s()}};
  }

  void refuse(std::string message, std::optional<std::size_t> keyframe) {
    result_.status = Status::kInvalid;
    result_.message = std::move(message);
    result_.keyframe = keyframe;
    result_.keyframes.clear();
  }

  // Ends with a timeout and without a path.
  void give_up(std::string_view before) {
    result_.status = Status::kTimeout;
    result_.message = fmt::format("the deadline came before {}: there is no path", before);
    result_.keyframes.clear();
    result_.keyframe_faults.clear();
  }

  // Returns whether a stage of that length has to be left out. Short ones never are.
  [[nodiscard]] bool leaves_too_little(double seconds) const {
    return seconds > kLeastBudget_s && !deadline_.leaves_s(seconds);
  }

  double lap_ms() {
    const double now_ms = deadline_.elapsed_ms();
    return now_ms - std::exchange(lap_begin_ms_, now_ms);
  }

  // A body of fewer tolerances gets a note in the message.
  static constexpr double kLeastTolerances = 10.0;

  // Shares of the time left. The stages that follow have to end by the deadline, too.
  static constexpr double kShareOfCorrection = 0.95;
  static constexpr double kShareOfWholeSearch = 0.7;
  static constexpr double kShareOfSlowing = 0.5;

  // Times of the stages, measured on two slow cores.
  static constexpr double kInterpolating_s_per_keyframe = 5e-6;
  static constexpr double kSearching_s_per_piece = 4e-6;
  static constexpr double kMeasuring_s_per_piece = 6e-6;
  static constexpr double kSlowing_s_per_piece = 10e-6;

  // Least time for the final check and for retiming, however little of the deadline is left: enough
  // for most paths.
  static constexpr double kLeastBudget_s = 0.02;

  const scene::Snapshot& snapshot_;
  const collision::Obstacles obstacles_;
  const PlanRequest& request_;
  const Deadline& deadline_;
  const collision::DetectOptions detect_;

  const double started_ms_ = deadline_.elapsed_ms();
  double lap_begin_ms_ = started_ms_;
  std::optional<motion::Body> body_;
  motion::TimeOrigin origin_;       ///< origin of all times until `to_sent_times`
  motion::CubicPath interpolated_;  ///< through the given keyframes
  bool is_as_interpolated_ = true;
  bool timed_out_ = false;
  bool is_searched_ = true;   ///< the path as interpolated was searched for collisions
  bool is_too_fast_ = false;  ///< the deadline came before the path was slowed
  std::optional<std::size_t> needed_keyframes_;  ///< set if corrections need more than allowed
  std::optional<motion::CubicPath> corrected_;   ///< path as corrected by the ladder, if it was
  std::optional<LimitBreach> breach_;            ///< motion limits that are not met
  bool slowed_everywhere_ = false;               ///< means nothing if `time_scale` is 1
  std::optional<motion::TimeLaw> law_;           ///< law that slowed the path, if any
  PlanResult result_;
};

PlanResult plan_among(const scene::Snapshot& snapshot, const collision::Obstacles& obstacles,
                      const PlanRequest& request, const Deadline& deadline) {
  const auto plan_at_size = [&](const PlanRequest& asked, const Deadline& until) {
    return Planner(snapshot, obstacles, asked, until).run();
  };
  return with_sent_times(may_shrink(request) ? plan_with_shrinking(request, deadline, plan_at_size)
                                             : plan_at_size(request, deadline));
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
    if (may_have_way_beyond(request, result) && !deadline.passed()) {
      add_way_beyond(plan_among(snapshot, scene.without_bounds(), request, deadline), request,
                     result);
    }
    result.deadline_reached = deadline.struck();
    if (result.deadline_reached && result.status == Status::kOk) {
      result.message += "; the deadline came before it was improved to the end";
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
