// SPDX-License-Identifier: MIT
#include "tools/drawing/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/drawing/panel_grid.h"
#include "tools/drawing/picture_file.h"

namespace camway::draw {
namespace {

// The width of a page of text in most browsers; letters stay legible.
constexpr double kPairWidth_px = 920.0;
constexpr double kPairMargin_px = 14.0;
constexpr double kPairTitle_px = 40.0;
constexpr double kPairLegend_px = 44.0;
constexpr double kPairLetters_px = 16.0;

/// A plan as one of the two columns shows it.
FloorPlan shown(FloorPlan plan, bool corrected) {
  if (corrected) {
    plan.before.clear();
    plan.collisions.clear();
  } else {
    plan.after.clear();
    plan.remaining_collisions.clear();
  }
  return plan;
}

/// A panel as one of the two columns shows it.
Panel shown_of(Panel panel, bool corrected) {
  std::erase_if(panel.keyframes,
                [](const PanelKeyframe& keyframe) { return keyframe.is_inserted; });
  std::erase_if(panel.collisions,
                [&](const PanelCollision& collision) { return collision.remains != corrected; });
  panel.corrected.clear();
  (corrected ? panel.before : panel.after) = {};
  return panel;
}

std::string count_of_collisions(std::size_t count) {
  if (count == 0) return "no collision";
  return count == 1 ? "1 collision" : fmt::format("{} collisions", count);
}

/// One line: the two marks, and the scale.
void draw_pair_legend(cairo_t* cr, const View& view, double height_px) {
  const double y = height_px - kPairLegend_px / 2;
  const auto label = [&](double x, std::string_view text) {
    draw_text(cr, {x, y + 5}, std::string(text), kPairLetters_px, palette::kInk);
  };
  draw_view_wedge(cr, {kPairMargin_px + 10, y}, 0.0, false);
  draw_keyframe_mark(cr, {kPairMargin_px + 10, y}, false);
  label(kPairMargin_px + 40, names::kGiven);
  draw_collision_mark(cr, {kPairMargin_px + 232, y}, false);
  label(kPairMargin_px + 252, names::kCollision);
  draw_scale_bar(cr, {kPairWidth_px - kPairMargin_px, y + 6}, view.px_per_m);
}

/// Draws what a column shows, with a sample of its line.
void draw_pair_title(cairo_t* cr, double x, bool corrected, std::size_t collisions) {
  const double y = kPairTitle_px - 14;
  cairo_move_to(cr, x, y - 6);
  cairo_line_to(cr, x + 40, y - 6);
  corrected ? stroke_after(cr) : stroke_before(cr);
  draw_text(cr, {x + 50, y}, (corrected ? "after: " : "before: ") + count_of_collisions(collisions),
            kPairLetters_px + 2, palette::kInk, 0.0, true);
}

}  // namespace

std::string draw_side_by_side(const FloorPlan& plan, const PictureFiles& files) {
  const std::vector<Panel> panels = storey_panels(plan);
  const PlanBox world = world_shown(plan);
  const double width = (kPairWidth_px - 3 * kPairMargin_px) / 2;
  const double height =
      std::clamp(width * world.sizes().y() / world.sizes().x(), 0.4 * width, 1.2 * width);
  const double row = height + kPairMargin_px;
  const PictureSize size{kPairWidth_px,
                         std::ceil(kPairTitle_px + static_cast<double>(panels.size()) * row -
                                   kPairMargin_px + kPairLegend_px)};
  const std::array plans{shown(plan, false), shown(plan, true)};
  return write_pictures(files, size, [&](cairo_t* cr) {
    View view = fitted({kPairMargin_px, kPairTitle_px, width, height}, world);
    for (const Panel& panel : panels) {
      for (const bool corrected : {false, true}) {
        view.frame.x = corrected ? 2 * kPairMargin_px + width : kPairMargin_px;
        draw_view(cr, view, plans[corrected ? 1 : 0], shown_of(panel, corrected));
        if (panels.size() == 1) continue;
        draw_text(cr, {view.frame.x + 8, view.frame.y + 18},
                  section_name(panel.section, plan.up, false), kLetters_px, palette::kInk);
      }
      view.frame.y += row;
    }
    draw_pair_title(cr, kPairMargin_px, false, plan.collisions.size());
    draw_pair_title(cr, 2 * kPairMargin_px + width, true, plan.remaining_collisions.size());
    draw_pair_legend(cr, view, size.height_px);
  });
}

}  // namespace camway::draw
