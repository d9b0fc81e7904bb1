// SPDX-License-Identifier: MIT
#include "tools/drawing/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/drawing/floor_plan_view.h"
#include "tools/drawing/picture_file.h"

namespace camway::draw {
namespace {

// The width of a page of text in most browsers; letters stay legible.
constexpr double kWidth_px = 920.0;
constexpr double kNarrowMargin_px = 14.0;
constexpr double kShortTitle_px = 44.0;
constexpr double kLowLegend_px = 46.0;
constexpr double kLetters_px = 16.0;

/// A plan as one of the two frames shows it.
FloorPlan shown(FloorPlan plan, bool corrected) {
  std::erase_if(plan.keyframes, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  if (corrected) {
    plan.before.clear();
    plan.collisions.clear();
  } else {
    plan.after.clear();
    plan.remaining_collisions.clear();
  }
  return plan;
}

std::string count_of_collisions(std::size_t count) {
  if (count == 0) return "no collision";
  return count == 1 ? "1 collision" : fmt::format("{} collisions", count);
}

/// One line: the two marks, and the scale.
void draw_legend(cairo_t* cr, const View& view, double height_px) {
  const double y = height_px - kLowLegend_px / 2;
  const auto label = [&](double x, const std::string& text) {
    draw_text(cr, {x, y + 6}, text, kLetters_px, palette::kInk);
  };
  draw_keyframe_mark(cr, {kNarrowMargin_px + 12, y}, 0.0, false);
  label(kNarrowMargin_px + 48, "keyframe, looking to the right");
  draw_collision_mark(cr, {kNarrowMargin_px + 348, y}, false);
  label(kNarrowMargin_px + 370, "collision");
  draw_scale_bar(cr, {kWidth_px - kNarrowMargin_px, y + 6}, view.px_per_m, kLetters_px);
}

}  // namespace

std::string draw_side_by_side(const FloorPlan& plan, const PictureFiles& files) {
  const FloorSection section =
      cut_floor(plan.mesh, plan.up,
                plan.cut_height_m.value_or(cut_height_m(plan.mesh, plan.up, plan.keyframes)));
  const PlanBox world = world_shown(plan);
  const double width = (kWidth_px - 3 * kNarrowMargin_px) / 2;
  const double height =
      std::clamp(width * world.sizes().y() / world.sizes().x(), 0.4 * width, 1.2 * width);
  const View left = fitted({kNarrowMargin_px, kShortTitle_px, width, height}, world);
  const View right = fitted({2 * kNarrowMargin_px + width, kShortTitle_px, width, height}, world);
  const PictureSize size{kWidth_px, std::ceil(kShortTitle_px + height + kLowLegend_px)};
  return write_pictures(files, size, [&](cairo_t* cr) {
    draw_view(cr, left, shown(plan, false), section);
    draw_view(cr, right, shown(plan, true), section);
    draw_text(cr, {left.frame.x, kShortTitle_px - 14},
              "before: " + count_of_collisions(plan.collisions.size()), kLetters_px + 3,
              palette::kBefore, 0.0, true);
    draw_text(cr, {right.frame.x, kShortTitle_px - 14},
              "after: " + count_of_collisions(plan.remaining_collisions.size()), kLetters_px + 3,
              palette::kAfter, 0.0, true);
    draw_legend(cr, left, size.height_px);
  });
}

}  // namespace camway::draw
