// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/pictures.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "lcmtypes/wire/channels.h"
#include "tools/answers/scene_record.h"
#include "tools/drawing/answer_plan.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/storeys.h"

namespace camway::tools {
namespace {

constexpr std::size_t kPictureSamples = 1000;

/// Returns the result of an answer; an empty one if there is no result.
planning::PlanResult drawn_result(const std::optional<RecordedAnswer>& answer) {
  if (!answer || !answer->result) return {};
  return result_of(*answer->result);
}

/// Returns the intervals that a drawing can show. A log may hold any.
std::vector<collision::CollisionInterval> drawable(
    std::vector<collision::CollisionInterval> intervals) {
  std::erase_if(intervals, [](const collision::CollisionInterval& interval) {
    return !std::isfinite(interval.t_begin_s) || !std::isfinite(interval.t_end_s);
  });
  return intervals;
}

std::vector<motion::Keyframe> drawable(std::vector<motion::Keyframe> keyframes) {
  std::erase_if(keyframes, [](const motion::Keyframe& keyframe) {
    return !std::isfinite(keyframe.time_s) || !keyframe.pose.position.allFinite() ||
           !keyframe.pose.orientation.coeffs().allFinite();
  });
  return keyframes;
}

}  // namespace

std::string picture_of(const ComparedRequest& compared, const SceneOf& scene_of,
                       const ReportHead& head) {
  const planning::PlanResult then = drawn_result(compared.recorded->answer);
  const planning::PlanResult now = drawn_result(compared.now);
  if (then.path.empty() && now.path.empty()) return {};
  draw::FloorPlan plan;
  const RecordedRequest& recorded = *compared.recorded;
  plan.title = wire::printable(
      fmt::format("{} {}, {}", recorded.ids.client_id, recorded.ids.request_id, recorded.scene));
  plan.subtitle = wire::printable(divergence_text(compared.difference));
  if (const auto scene = scene_of(recorded)) plan.mesh = *scene->mesh.share();
  plan.path_names = {head.then, head.now};
  if (recorded.request) {
    const std::optional<draw::SceneUp> told = vertical_axis(std::nullopt, *recorded.request);
    plan.up = told ? *told : draw::up_of(plan.mesh);
    draw::set_body(*recorded.request, plan);
  }
  if (!then.path.empty()) plan.before = draw::sample(then.path, kPictureSamples);
  if (!now.path.empty()) plan.after = draw::sample(now.path, kPictureSamples);
  plan.keyframes = drawable(now.path.empty() ? then.keyframes : now.keyframes);
  plan.collisions = drawable(then.remaining_collisions);
  plan.remaining_collisions = drawable(now.remaining_collisions);
  return draw::floor_plan_svg(plan);
}

Pictures pictures_of(const std::vector<ComparedRequest>& compared, const SceneOf& scene_of,
                     const ReportHead& head, const PictureLimits& limits) {
  Pictures pictures;
  std::size_t bytes = 0;
  for (const std::size_t index : worst_first(compared)) {
    if (pictures.list.size() == limits.most) break;
    std::string svg = picture_of(compared[index], scene_of, head);
    if (svg.empty()) continue;
    bytes += svg.size();
    pictures.is_cut = bytes > limits.most_bytes;
    if (pictures.is_cut) break;
    pictures.list.push_back({index, std::move(svg)});
  }
  return pictures;
}

}  // namespace camway::tools
