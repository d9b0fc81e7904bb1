// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/request/validate.h"
#include "daemon/planning/stages/keyframe_faults.h"
#include "daemon/planning/stages/keyframe_times.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/stages/sentences.h"
#include "daemon/planning/stages/stage_times.h"

namespace camway::planning {

namespace {

void refuse(std::string message, std::optional<std::size_t> keyframe, PlanResult& result) {
  result.status = Status::kInvalid;
  result.message = std::move(message);
  result.keyframe = keyframe;
  result.keyframes.clear();
}

// Ends with a timeout and without a path.
void give_up(std::string why, PlanResult& result) {
  result.status = Status::kTimeout;
  result.message = std::move(why) + "; no path was made";
  result.keyframes.clear();
  result.keyframe_faults.clear();
}

// Returns the body of a request; nothing if the request is invalid, whatever the scene.
std::optional<motion::Body> valid_body(const collision::Obstacles& obstacles,
                                       const PlanRequest& request, PlanResult& result) {
  if (std::optional<InvalidRequest> fault = validate(request)) {
    refuse(std::move(fault->message), fault->keyframe, result);
    return std::nullopt;
  }
  result.bounds = obstacles.bounds;
  if (geometry::fault_in(obstacles.bounds)) {
    refuse(request.name_of("options.bounds") + ": leave no room within the bounds of the scene",
           std::nullopt, result);
    return std::nullopt;
  }
  base::Result<motion::Body> body = motion::Body::make(body_shape(request));
  if (!body) refuse("body: " + body.error, std::nullopt, result);
  return std::move(body.value);
}

// Repairs the keyframes of `result` that are at fault, if the request asks for that. Returns false
// if the request cannot be planned, or not in time.
bool accept_keyframes(KeyframeFaults found, const PlanRequest& request, double surface_error_m,
                      const base::Deadline& deadline, PlanResult& result) {
  result.keyframe_faults = std::move(found.faults);
  const std::vector<KeyframeFault>& faults = result.keyframe_faults;
  const bool all_free = std::ranges::all_of(
      faults, [](const KeyframeFault& fault) { return fault.free_pose.has_value(); });
  const bool may_repair =
      request.options.repair_keyframes && all_free && faults.size() < kMostKeyframeFaults;
  if (!faults.empty() && !may_repair) {
    refuse(why_refused(faults, request, surface_error_m, deadline.passed(), found.complete),
           fault_to_name(faults, request).keyframe, result);
    return false;
  }
  for (const KeyframeFault& fault : faults) {
    result.keyframes[fault.keyframe].pose = *fault.free_pose;
    result.keyframes[fault.keyframe].is_repaired = true;
  }
  if (!found.complete) {
    give_up(deadline_text(request) + " before all keyframes were looked at", result);
  }
  return found.complete;
}

}  // namespace

motion::CubicPath interpolated_path(const PlanRequest& request,
                                    const std::vector<motion::Keyframe>& keyframes,
                                    const motion::TimeOrigin& origin) {
  return request.frame ? motion::interpolate_cubic(keyframes, *request.frame)
                       : motion::interpolate_cubic(keyframes, origin);
}

std::optional<PreparedPlan> prepare(const scene::Snapshot& snapshot,
                                    const collision::Obstacles& obstacles,
                                    const PlanRequest& request, const base::Deadline& deadline,
                                    PlanResult& result) {
  deadline.report(base::Progress::Stage::kPreparing);
  std::optional<motion::Body> body = valid_body(obstacles, request, result);
  if (!body) return std::nullopt;
  PreparedKeyframes prepared = prepared_keyframes(request);
  result.keyframes = std::move(prepared.keyframes);
  KeyframeFaults faults = find_keyframe_faults(
      snapshot, {obstacles, *body, detect_options(request.options)}, result.keyframes, deadline);
  if (!accept_keyframes(std::move(faults), request, obstacles.surface_error_m, deadline, result))
    return std::nullopt;
  const auto count = static_cast<double>(result.keyframes.size());
  if (leaves_too_little(deadline, kInterpolating_s_per_keyframe * count)) {
    give_up(fmt::format("the deadline of {} s is too short to interpolate {} keyframes",
                        request.options.deadline_s, result.keyframes.size()),
            result);
    return std::nullopt;
  }
  motion::CubicPath interpolated = interpolated_path(request, result.keyframes, prepared.origin);
  result.path = interpolated.path();
  if (request.frame) {
    result.keyframes = motion::keyframes_of(interpolated, result.keyframes);
    result.frame = motion::frame_of(interpolated);
  }
  return PreparedPlan{std::move(*body), prepared.origin, std::move(interpolated), result.keyframes,
                      result.frame};
}

}  // namespace camway::planning
