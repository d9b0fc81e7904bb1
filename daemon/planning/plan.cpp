// SPDX-License-Identifier: MIT
#include "daemon/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <string>
#include <utility>

#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/correction/free_space.h"
#include "daemon/correction/keyframe_insertion.h"
#include "daemon/correction/ladder.h"
#include "daemon/motion/interpolate.h"
#include "daemon/planning/check.h"
#include "daemon/planning/effort_text.h"
#include "daemon/planning/keyframe_faults.h"
#include "daemon/planning/limits.h"
#include "daemon/planning/search_changes.h"
#include "daemon/planning/shrink.h"

namespace camway::planning {

namespace {

using collision::CollisionInterval;
using collision::Deadline;
using motion::Keyframe;

// The keyframes as planning uses them: unit quaternions, times derived where none were given.
std::vector<Keyframe> prepared_keyframes(const PlanRequest& request) {
  std::vector<Keyframe> keyframes = request.keyframes;
  std::vector<motion::Pose> poses;
  poses.reserve(keyframes.size());
  for (Keyframe& keyframe : keyframes) {
    keyframe.pose.orientation.normalize();
    keyframe.origin = motion::KeyframeOrigin::kGiven;
    keyframe.is_repaired = false;
    poses.push_back(keyframe.pose);
  }
  if (request.has_times) return keyframes;
  const std::vector<double> times_s = motion::derive_times_s(
      poses, request.options.default_speed_m_per_s.value_or(motion::kNominalSpeed_m_per_s));
  for (std::size_t i = 0; i < keyframes.size(); ++i) keyframes[i].time_s = times_s[i];
  return keyframes;
}

double colliding_s(const std::vector<CollisionInterval>& intervals) {
  double sum_s = 0.0;
  for (const CollisionInterval& interval : intervals)
    sum_s += interval.t_end_s - interval.t_begin_s;
  return sum_s;
}

// The stages in order, each adding to the result.
class Planner {
 public:
  Planner(const scene::Snapshot& snapshot, const PlanRequest& request, const Deadline& deadline)
      : snapshot_(snapshot),
        obstacles_(snapshot),
        request_(request),
        deadline_(deadline),
        detect_(detect_options(request.options)) {}

  PlanResult run() && {
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
    return std::move(result_);
  }

 private:
  // Motion through the keyframes; false if the request cannot be planned.
  bool prepare() {
    deadline_.report(collision::Progress::Stage::kPreparing);
    if (std::optional<InvalidRequest> fault = validate(request_)) {
      refuse(std::move(fault->message), fault->keyframe);
      return false;
    }
    std::string fault;
    body_ = motion::Body::make(request_.body.value_or(request_.camera), fault);
    if (!body_) {
      refuse("body: " + fault, std::nullopt);
      return false;
    }
    result_.keyframes = prepared_keyframes(request_);
    if (!keyframes_are_free()) return false;
    interpolated_ = motion::interpolate_cubic(result_.keyframes);
    result_.path = interpolated_.path();
    result_.timing.motion_ms = lap_ms();
    return true;
  }

  // Those that are not are moved to where they would be, if that was asked for; else the request
  // cannot be planned.
  bool keyframes_are_free() {
    result_.keyframe_faults =
        find_keyframe_faults(snapshot_, *body_, detect_, result_.keyframes, deadline_);
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
    return true;
  }

  void refuse_keyframes() {
    const std::vector<KeyframeFault>& faults = result_.keyframe_faults;
    // Where keyframes were to be repaired, one that could not be is what is wrong.
    const auto lost = std::ranges::find_if(faults, [&](const KeyframeFault& fault) {
      return request_.options.repair_keyframes && !fault.free_pose;
    });
    const KeyframeFault& first = lost == faults.end() ? faults.front() : *lost;
    const std::string body = body_->is_camera() ? "near quadrilateral" : "body";
    const std::string rule =
        detect_.clearance_m > 0.0
            ? fmt::format(
                  "is nearer to the scene than the clearance of {:.3g} m that was asked for",
                  detect_.clearance_m)
            : std::string("collides with the scene");
    std::string message = fmt::format("keyframes[{}]: the {} {} there, by about {:.3g} m",
                                      first.keyframe, body, rule, first.depth_m);
    if (first.free_pose) {
      const geometry::Vec3& to = first.free_pose->position;
      message +=
          fmt::format("; it would be free at ({:.4g}, {:.4g}, {:.4g})", to.x(), to.y(), to.z());
    } else {
      message += lost == faults.end() ? "; " : "; it could not be repaired: ";
      message += deadline_.passed() ? "the deadline came before a free pose was found"
                                    : "no free pose was found near it";
    }
    if (faults.size() > 1) message += fmt::format("; {} keyframes are at fault", faults.size());
    if (faults.size() >= kMostKeyframeFaults && request_.options.repair_keyframes)
      message += ", too many to be repaired";
    refuse(std::move(message), first.keyframe);
  }

  // Whether the path as interpolated collides, and where. Nothing if the deadline struck.
  std::optional<std::vector<CollisionInterval>> find_collisions() {
    deadline_.report(collision::Progress::Stage::kDetecting);
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
    deadline_.report(collision::Progress::Stage::kCorrecting);
    if (request_.options.method == Method::kLadder) {
      correct_by_ladder(*found);
    } else if (body_->is_camera()) {
      // The seed's method knows near quadrilaterals, and no clearance.
      insert_keyframes();
    }
    result_.timing.correct_ms = lap_ms();
  }

  void correct_by_ladder(const std::vector<CollisionInterval>& found) {
    correction::LadderOptions options;
    options.detect = detect_;
    options.max_inserted_keyframes = request_.options.max_inserted_keyframes;
    options.seed = request_.options.seed;
    options.objective = request_.options.objective;
    options.orientation = request_.options.orientation;
    options.max_shrink = request_.body ? 0.0 : request_.options.max_shrink;
    options.rest_s_per_piece = kSearching_s_per_piece + rest_s_per_piece();
    correction::LadderResult corrected = correction::correct_by_ladder(
        snapshot_.mesh, obstacles_, *body_, result_.keyframes, interpolated_, found, options,
        deadline_.share_of_rest(kShareOfCorrection));
    timed_out_ = corrected.timed_out;
    needed_keyframes_ = corrected.needed_keyframes;
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
    correction::KeyframeInsertionOptions options;
    options.sweep = {request_.options.chord_error_m, detect_};
    options.max_inserted_keyframes = request_.options.max_inserted_keyframes;
    correction::KeyframeInsertionResult corrected = correction::insert_keyframes(
        obstacles_.index, result_.keyframes, motion::near_corners_C(request_.camera), options,
        deadline_.share_of_rest(kShareOfCorrection).sooner_by_s(rest_s()));
    is_as_interpolated_ = false;
    result_.keyframes = std::move(corrected.keyframes);
    result_.path = std::move(corrected.path);
    timed_out_ = corrected.timed_out;
  }

  // What comes after the final check, for each piece of the path, and in all.
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
    deadline_.report(collision::Progress::Stage::kCertifying);
    const Deadline budget = deadline_.sooner_by_s(rest_s()).not_before_s(kLeastBudget_s);
    // As interpolated, these very segments were searched already.
    result_.remaining_collisions = is_as_interpolated_ ? result_.collisions : final_search(budget);
    if (result_.remaining_collisions.empty()) {
      result_.certificate = certificate_of_free(obstacles_, result_.path, *body_, detect_, budget);
    }
    result_.timing.certify_ms = lap_ms();
  }

  // Of the whole path; where there is no time for that, of what was changed.
  std::vector<CollisionInterval> final_search(const Deadline& budget) {
    collision::Search whole{false, {}, result_.path.begin_s()};
    if (!timed_out_) {
      whole = collision::search_collisions(obstacles_, result_.path, *body_, result_.path.begin_s(),
                                           result_.path.end_s(), detect_,
                                           budget.share_of_rest(kShareOfWholeSearch));
    }
    if (whole.complete) return std::move(whole.collisions);
    timed_out_ = true;
    // The seed's method changes the path everywhere.
    const motion::Path before = corrected_ ? interpolated_.path() : motion::Path();
    collision::Search changes = search_changes(obstacles_, result_.path, *body_, detect_,
                                               {before, result_.collisions}, whole, budget);
    if (!changes.complete) give_up_corrections(changes.until_s);
    return std::move(changes.collisions);
  }

  // There was no time to check them.
  void give_up_corrections(double from_s) {
    put_back(from_s);
    for (correction::Correction& correction : result_.corrections) {
      if (correction.interval.t_end_s > from_s) correction = {correction.interval};
    }
  }

  // From then on the path as interpolated, whose collisions are known.
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

  // Corrections of some intervals can bend the spline into others. Who gets a path that collides
  // anyway shall not get one that collides for longer than what he asked for.
  void keep_the_better_path() {
    if (colliding_s(result_.remaining_collisions) <= colliding_s(result_.collisions)) return;
    if (result_.collisions.empty()) return;
    put_back(result_.path.begin_s());
    result_.remaining_collisions = result_.collisions;
  }

  void measure() {
    if (result_.path.empty()) return;
    const motion::Path before = interpolated_.path();
    result_.measures_before = motion::measure(before, before);
    if (result_.collisions.empty()) {
      result_.measures_before->clearance_lower_bound_m =
          result_.certificate.clearance_lower_bound_m;
    }
    result_.measures =
        is_as_interpolated_ ? result_.measures_before : motion::measure(result_.path, before);
  }

  // Corrections and limits both change the path and its proof; this tells of what they left.
  void add_clearance() {
    if (result_.measures) {
      result_.measures->clearance_lower_bound_m = result_.certificate.clearance_lower_bound_m;
    }
  }

  // Slower where the path is faster than the limits allow. A path that collides is not worth a new
  // curve: it is made slower all the way, which leaves its collisions where they are.
  void meet_limits() {
    const correction::MotionLimits& limits = request_.options.limits;
    if (!result_.measures || !limits.any()) return;
    if (!limits.may_retime) breach_ = find_limit_breach(result_.path, limits);
    if (!limits.may_retime || meets_limits(result_.path, limits)) return;
    const motion::CubicPath path = corrected_ ? *corrected_
                                   : is_as_interpolated_
                                       ? interpolated_
                                       : motion::interpolate_cubic(result_.keyframes);
    // The policy is for what the ladder corrects.
    const correction::OrientationPolicy policy =
        corrected_ ? request_.options.orientation : correction::OrientationPolicy{};
    const TooFast too_fast{path, interpolated_, limits, policy, obstacles_, *body_, detect_};
    std::optional<Retimed> slowed;
    if (result_.certificate.certified) {
      slowed = slowed_where_needed(too_fast, deadline_.share_of_rest(kShareOfSlowing));
    }
    slowed_everywhere_ = !slowed;
    if (!slowed) slowed = slowed_alike(too_fast, deadline_.not_before_s(kLeastBudget_s));
    is_too_fast_ = !slowed;
    if (slowed) take(std::move(*slowed));
    result_.timing.certify_ms += lap_ms();
  }

  void take(Retimed slowed) {
    move_times(slowed.law, result_);
    result_.path = slowed.path.path();
    for (Keyframe& keyframe : result_.keyframes) {
      if (keyframe.origin == motion::KeyframeOrigin::kInserted)
        keyframe.pose = result_.path.pose(keyframe.time_s);
    }
    if (slowed.certificate) result_.certificate = *slowed.certificate;
    result_.measures = motion::measure(result_.path, slowed.interpolated.path());
  }

  // Fine for a flight around an object, but more often the unit or the axes of the file are not
  // what was assumed, and then everything looks free.
  [[nodiscard]] std::string note() const {
    return note_of_bounds() + note_of_tilt() + note_of_tolerance() + note_of_method(request_);
  }

  // What cannot be told from a collision at the tolerance counts as one, and for a tiny body that
  // can be every gap it would fit through.
  [[nodiscard]] std::string note_of_tolerance() const {
    const double size_m = 2.0 * correction::FreeSpace(obstacles_, *body_, detect_).ball_radius_m();
    if (!(size_m < kLeastTolerances * detect_.tolerance_m)) return {};
    return fmt::format("; note: the body is {:.2g} m large, and {} of {:.2g} m is coarse for that",
                       size_m, request_.name_of("options.interval_tolerance_m"),
                       detect_.tolerance_m);
  }

  [[nodiscard]] std::string note_of_bounds() const {
    const bool inside = std::ranges::any_of(result_.keyframes, [&](const Keyframe& keyframe) {
      return obstacles_.index.bounds().contains(keyframe.pose.position);
    });
    if (inside || obstacles_.index.bounds().isEmpty()) return {};
    return "; note: no keyframe lies within the bounds of the scene, check its scale and axes";
  }

  // Fine for who wants it so, but more often another axis is up in the scene.
  [[nodiscard]] std::string note_of_tilt() const {
    const correction::OrientationPolicy& policy = request_.options.orientation;
    if (policy.rule != correction::OrientationRule::kLevel) return {};
    for (std::size_t i = 0; i < request_.keyframes.size(); ++i) {
      const geometry::Vec3 across_W =
          request_.keyframes[i].pose.orientation.normalized() * geometry::Vec3::UnitX();
      const double tilt_rad =
          std::atan2(std::abs(policy.up_W.dot(across_W)), policy.up_W.cross(across_W).norm());
      if (tilt_rad < kNotableTilt_rad) continue;
      return fmt::format("; note: keyframe {} is tilted by {:.0f} degrees, check {}", i,
                         tilt_rad * 180.0 / std::numbers::pi,
                         request_.name_of("options.orientation.up"));
    }
    return {};
  }

  [[nodiscard]] std::size_t inserted_keyframes() const {
    return static_cast<std::size_t>(std::ranges::count(
        result_.keyframes, motion::KeyframeOrigin::kInserted, &Keyframe::origin));
  }

  void conclude() {
    const std::size_t inserted = inserted_keyframes();
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
      result_.message = fmt::format("{} found, {} inserted{}, proved free with {:.3g} m clearance",
                                    counted(result_.collisions.size(), "collision"),
                                    counted(inserted, "keyframe"), repaired(),
                                    result_.certificate.clearance_lower_bound_m) +
                        note_of_times() + note();
      return;
    }
    if (result_.infeasibility) {
      result_.status = Status::kInfeasible;
      const bool may_shrink = request_.options.max_shrink > 0.0 && !request_.body;
      result_.message = why_infeasible(*result_.infeasibility, may_shrink) + note();
      return;
    }
    result_.status = timed_out_ ? Status::kTimeout : Status::kPartial;
    if (!is_searched_) {
      result_.message =
          "the deadline came before the path was searched for collisions: nothing is known of it" +
          note_of_haste() + note();
      return;
    }
    result_.message = fmt::format("{}{} found, {} inserted{}, {} left on the path",
                                  timed_out_ ? "the deadline came first: " : "",
                                  counted(result_.collisions.size(), "collision"),
                                  counted(inserted, "keyframe"), repaired(), remaining) +
                      note_of_keyframe_limit() + note_of_effort(result_.corrections) +
                      note_of_haste() + note_of_times() + note();
  }

  // What the deadline left undone.
  [[nodiscard]] std::string note_of_haste() const {
    return is_too_fast_ ? "; it was not slowed to meet " + request_.name_of("options.limits") : "";
  }

  [[nodiscard]] std::string note_of_keyframe_limit() const {
    const std::int32_t most = request_.options.max_inserted_keyframes;
    if (result_.collisions.empty()) return {};
    const std::string field = request_.name_of("options.max_inserted_keyframes");
    if (most == 0) return fmt::format("; nothing was corrected, as {} asks for", field);
    // The seed's method does not say what it would need.
    const bool is_used_up = std::cmp_greater_equal(inserted_keyframes(), most);
    if (!needed_keyframes_ && !is_used_up) return {};
    if (!needed_keyframes_) return fmt::format("; {} allows {}", field, most);
    return fmt::format("; {} allows {}, the corrections that were found need {}", field, most,
                       *needed_keyframes_);
  }

  [[nodiscard]] std::string repaired() const {
    const std::size_t count = result_.keyframe_faults.size();
    return count == 0 ? std::string() : fmt::format(", {} repaired", count);
  }

  [[nodiscard]] std::string why_too_fast() const {
    return fmt::format(
        "{}: the path is free, but too fast from {:.5g} s to {:.5g} s{}: {}; allow {}, or give "
        "later times",
        request_.name_of("options.limits"), breach_->t_begin_s, breach_->t_end_s,
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

  // Nothing is known of the path: then all of it counts as colliding.
  void mark_all_as_remaining() {
    result_.remaining_collisions = {{result_.path.begin_s(), result_.path.end_s()}};
  }

  void refuse(std::string message, std::optional<std::size_t> keyframe) {
    result_.status = Status::kInvalid;
    result_.message = std::move(message);
    result_.keyframe = keyframe;
    result_.keyframes.clear();
  }

  double lap_ms() {
    const double now_ms = deadline_.elapsed_ms();
    return now_ms - std::exchange(lap_begin_ms_, now_ms);
  }

  // A body that is fewer tolerances large is told so.
  static constexpr double kLeastTolerances = 10.0;

  // Cameras are seldom rolled by so much: 30 degrees.
  static constexpr double kNotableTilt_rad = 0.5236;

  // Of what is left: what comes after these has to be done by the deadline, too.
  static constexpr double kShareOfCorrection = 0.95;
  static constexpr double kShareOfWholeSearch = 0.7;
  static constexpr double kShareOfSlowing = 0.5;

  // The final check, and what comes after it; measured, on two slow cores.
  static constexpr double kSearching_s_per_piece = 4e-6;
  static constexpr double kMeasuring_s_per_piece = 6e-6;
  static constexpr double kSlowing_s_per_piece = 10e-6;

  // For the final check and for stretching times, however little of the deadline is left: enough
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
  motion::CubicPath interpolated_;  ///< through the given keyframes
  bool is_as_interpolated_ = true;
  bool timed_out_ = false;
  bool is_searched_ = true;                      ///< the path as interpolated, for collisions
  bool is_too_fast_ = false;                     ///< as the deadline came before it was slowed
  std::optional<std::size_t> needed_keyframes_;  ///< set if more than allowed
  std::optional<motion::CubicPath> corrected_;   ///< what the ladder made of the path, if anything
  std::optional<LimitBreach> breach_;            ///< limits that are not met
  bool slowed_everywhere_ = false;               ///< where `time_scale` is not 1
  PlanResult result_;
};

}  // namespace

PlanResult plan(const scene::Snapshot& snapshot, const PlanRequest& request,
                const Deadline& deadline) {
  try {
    const auto plan_at_size = [&](const PlanRequest& asked, const Deadline& until) {
      return Planner(snapshot, asked, until).run();
    };
    const bool may_shrink = request.options.max_shrink > 0.0 && !request.body;
    PlanResult result = may_shrink ? plan_with_shrinking(request, deadline, plan_at_size)
                                   : plan_at_size(request, deadline);
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
