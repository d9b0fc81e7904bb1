// SPDX-License-Identifier: MIT
#include "tools/view/plan_picture.h"

#include <optional>

#include "tools/answers/scene_record.h"
#include "tools/drawing/answer_plan.h"

namespace camway::view {

std::string plan_picture(const LastPlan& last) {
  draw::FloorPlan plan =
      draw::plan_of_answer(last.request, last.result, last.mesh ? *last.mesh : scene::Mesh());
  plan.title = last.request.scene;
  plan.up = tools::vertical_axis(std::nullopt, last.request);
  return draw::floor_plan_svg(plan);
}

}  // namespace camway::view
