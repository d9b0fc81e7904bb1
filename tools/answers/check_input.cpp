// SPDX-License-Identifier: MIT
#include "tools/answers/check_input.h"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/planning/request/validate.h"
#include "daemon/planning/result/path_faults.h"
#include "daemon/planning/stages/path_check.h"

namespace camway::tools {
namespace {

base::Failure faulty(const std::string& document, const std::string& fault) {
  return {document + ": " + fault};
}

/// Returns the request's keyframes with their times: those of the request, or those of the response
/// if the request has none or the path was slowed. Returns nothing if the times of the response do
/// not increase. Wrong times cannot hide a missed keyframe, only cause one.
std::vector<motion::Keyframe> timed_keyframes(const planning::PlanRequest& request,
                                              const PathFile& response) {
  std::vector<motion::Keyframe> keyframes = request.keyframes;
  if (request.has_times && response.time_scale == 1.0) return keyframes;
  std::size_t count = 0;
  double before_s = -std::numeric_limits<double>::infinity();
  for (const motion::Keyframe& passed : response.keyframes) {
    if (passed.origin == motion::KeyframeOrigin::kInserted) continue;
    if (count == keyframes.size() || !(before_s < passed.time_s)) return {};
    before_s = passed.time_s;
    keyframes[count++].time_s = before_s;
  }
  if (count < keyframes.size()) keyframes.clear();
  return keyframes;
}

}  // namespace

base::Result<CheckInput> check_input(const RequestFile& request, const PathFile& response,
                                     const CheckNames& names) {
  if (const auto fault = planning::validate(request)) {
    return faulty(names.request, fault->message);
  }
  auto body = motion::Body::make(planning::body_shape(request, response.near_scale));
  if (!body) return faulty(names.request, "body: " + body.error);
  std::optional<std::string> fault = planning::find_fault(response.path.segments());
  if (!fault) fault = planning::find_jump(response.path, body->radius_m());
  if (fault) return faulty(names.response, *fault);
  // Only the response has the bounds of the scene that it was planned in.
  const geometry::Bounds bounds = request.options.bounds.within(response.bounds);
  return CheckInput{request,
                    response.path,
                    names.response,
                    timed_keyframes(request, response),
                    *std::move(body),
                    nullptr,
                    response.scene_digest,
                    response.near_scale,
                    bounds};
}

PathSearch search_path(const CheckInput& input, const base::Deadline& deadline) {
  return search_path({collision::Obstacles(*input.snapshot).within(input.bounds), *input.body,
                      planning::detect_options(input.request.options)},
                     input.path, deadline);
}

}  // namespace camway::tools
