// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/shot.h"

#include "daemon/correction/path/viewing_distance.h"
#include "daemon/motion/spline/interpolate.h"

namespace camway::bench {

namespace {

planning::PlanRequest plan_of(const BenchRequest& request, double deadline_s) {
  planning::PlanRequest plan = request.plan;
  plan.frame.reset();
  plan.options = {};
  plan.options.deadline_s = deadline_s;
  plan.options.clearance_m = request.plan.options.clearance_m;
  plan.options.bounds = request.plan.options.bounds;
  plan.options.viewing_distance_m = request.plan.options.viewing_distance_m;
  const double begin_s = plan.keyframes.front().time_s;
  for (motion::Keyframe& keyframe : plan.keyframes) keyframe.time_s -= begin_s;
  return plan;
}

correction::FreeSpace space_for(const collision::Query& query, const motion::CubicPath& path,
                                const planning::PlanOptions& options) {
  const correction::FreeSpace unscaled(query);
  return correction::FreeSpace(
      query, options.orientation,
      correction::closeness_of(path, unscaled, options.viewing_distance_m.value_or(0.0)));
}

}  // namespace

Shot::Shot(const scene::Snapshot& snapshot, const BenchRequest& request, double deadline_s)
    : snapshot_(snapshot),
      request_(request),
      plan_(plan_of(request, deadline_s)),
      body_(request.camera),
      interpolated_(motion::interpolate_cubic(plan_.keyframes)),
      original_(interpolated_.path()),
      query_{collision::Obstacles(snapshot).within(plan_.options.bounds), body_,
             planning::detect_options(plan_.options)},
      space_(space_for(query_, interpolated_, plan_.options)),
      collisions_(check(original_).collisions.size()) {}

double Shot::cost(const motion::CubicPath& path) const {
  return correction::closeness_cost(path, interpolated_, closeness());
}

planning::PathCheck Shot::check(const motion::Path& path) const {
  return planning::check_path(query_, path, base::Deadline::never(), base::Deadline::never());
}

correction::FreeSpace Shot::space_with(double clearance_m) const {
  collision::Query query = query_;
  query.options.clearance_m = clearance_m;
  return correction::FreeSpace(query, plan_.options.orientation, closeness());
}

std::optional<double> Shot::certified_clearance_m(const motion::Path& path) const {
  const planning::Certificate certificate = check(path).certificate;
  if (!certificate.certified) return std::nullopt;
  return certificate.clearance_lower_bound_m;
}

}  // namespace camway::bench
