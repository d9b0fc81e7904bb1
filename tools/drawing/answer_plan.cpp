// SPDX-License-Identifier: MIT
#include "tools/drawing/answer_plan.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "daemon/motion/spline/interpolate.h"

namespace camway::draw {
namespace {

/// Samples of a path: dense enough to be drawn as a line on a page.
constexpr std::size_t kPageSamples = 1500;

std::vector<motion::Keyframe> given_keyframes(const planning::PlanResult& result) {
  std::vector<motion::Keyframe> given = result.keyframes;
  std::erase_if(given, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return given;
}

}  // namespace

FloorPlan plan_of_answer(const motion::Camera& camera, const planning::PlanResult& result,
                         scene::Mesh mesh) {
  FloorPlan plan;
  plan.subtitle = fmt::format("{}: {}", planning::to_string(result.status), result.message);
  plan.mesh = std::move(mesh);
  plan.corners_C = motion::near_corners_C(camera);
  plan.keyframes = result.keyframes;
  plan.before = sample(motion::interpolate(given_keyframes(result)), kPageSamples);
  plan.after = sample(result.path, kPageSamples);
  plan.collisions = result.collisions;
  plan.remaining_collisions = result.remaining_collisions;
  for (const correction::Correction& correction : result.corrections) {
    if (correction.kind == correction::CorrectionKind::kNone) continue;
    plan.corrected.push_back({correction.t_begin_s, correction.t_end_s});
  }
  if (result.infeasibility) plan.barrier = barrier_of(*result.infeasibility, plan.mesh);
  return plan;
}

}  // namespace camway::draw
