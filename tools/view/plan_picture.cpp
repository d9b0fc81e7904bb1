// SPDX-License-Identifier: MIT
#include "tools/view/plan_picture.h"

#include <optional>

#include "tools/answers/scene_record.h"
#include "tools/drawing/answer_plan.h"
#include "tools/drawing/storeys.h"

namespace camway::view {

std::string plan_picture(const LastPlan& last) {
  draw::FloorPlan plan =
      draw::plan_of_answer(last.request, last.result, last.mesh ? *last.mesh : scene::Mesh());
  plan.title = last.request.scene;
  const std::optional<draw::SceneUp> told = tools::vertical_axis(std::nullopt, last.request);
  plan.up = told ? *told : draw::up_of(plan.mesh);
  return draw::floor_plan_svg(plan);
}

}  // namespace camway::view
