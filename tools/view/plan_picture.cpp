// SPDX-License-Identifier: MIT
#include "tools/view/plan_picture.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "tools/answers/scene_record.h"
#include "tools/drawing/floor_plan.h"

namespace camway::view {
namespace {

constexpr std::size_t kPageSamples = 1500;

std::vector<motion::Keyframe> keyframes_given(const planning::PlanResult& result) {
  std::vector<motion::Keyframe> given = result.keyframes;
  std::erase_if(given, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return given;
}

}  // namespace

std::string plan_picture(const LastPlan& last) {
  draw::FloorPlan plan;
  plan.title = last.request.scene;
  plan.subtitle =
      fmt::format("{}: {}", planning::to_string(last.result.status), last.result.message);
  if (last.mesh) plan.mesh = *last.mesh;
  plan.up = tools::vertical_axis(std::nullopt, last.request);
  plan.corners_C = motion::near_corners_C(last.request.camera);
  plan.keyframes = last.result.keyframes;
  plan.before = draw::sample(motion::interpolate(keyframes_given(last.result)), kPageSamples);
  plan.after = draw::sample(last.result.path, kPageSamples);
  plan.collisions = last.result.collisions;
  plan.remaining_collisions = last.result.remaining_collisions;
  if (last.result.infeasibility) {
    plan.barrier = draw::barrier_of(*last.result.infeasibility, plan.mesh);
  }
  return draw::floor_plan_svg(plan);
}

}  // namespace camway::view
