// SPDX-License-Identifier: MIT
#include "tools/drawing/legend.h"

#include <cmath>
#include <utility>

namespace camway::draw {
namespace {

constexpr std::size_t kColumns = 4;
constexpr double kRow_px = 24.0;

void sample_line(cairo_t* cr, const PlanPoint& at) {
  cairo_move_to(cr, at.x() - 20, at.y());
  cairo_line_to(cr, at.x() + 20, at.y());
}

LegendEntry line_entry(void (*stroke_line)(cairo_t*), std::string text) {
  return {[stroke_line](cairo_t* cr, const PlanPoint& at) {
            sample_line(cr, at);
            stroke_line(cr);
          },
          std::move(text)};
}

LegendEntry keyframe_entry(bool inserted, std::string text) {
  return {[inserted](cairo_t* cr, const PlanPoint& at) {
            draw_view_wedge(cr, at, 0.0, inserted);
            draw_keyframe_mark(cr, at, inserted);
          },
          std::move(text)};
}

LegendEntry collision_entry(bool remains, std::string text) {
  return {[remains](cairo_t* cr, const PlanPoint& at) {
            sample_line(cr, at);
            stroke_collision(cr);
            draw_collision_mark(cr, at, remains);
          },
          std::move(text)};
}

LegendEntry quad_entry(const Color& color, std::string text) {
  return {[color](cairo_t* cr, const PlanPoint& at) {
            cairo_rectangle(cr, at.x() - 16, at.y() - 3.5, 32, 7);
            stroke(cr, color, 1.6);
          },
          std::move(text)};
}

LegendEntry area_entry(const Color& fill, const Color& rim, std::string text) {
  return {[fill, rim](cairo_t* cr, const PlanPoint& at) {
            cairo_rectangle(cr, at.x() - 18, at.y() - 6, 36, 12);
            set_color(cr, fill);
            cairo_fill_preserve(cr);
            stroke(cr, rim, 1.2);
          },
          std::move(text)};
}

LegendEntry corner_entry() {
  return {[](cairo_t* cr, const PlanPoint& at) {
            sample_line(cr, at);
            stroke(cr, faded(palette::kAfter, 0.5), 0.9);
          },
          "curves of its corners"};
}

}  // namespace

std::vector<LegendEntry> section_legend() {
  return {area_entry(palette::kWallFill, palette::kWall, "cut"),
          area_entry(palette::kTop, palette::kOutline, "below the cut")};
}

std::vector<LegendEntry> legend_of(const FloorPlan& plan, bool has_several_storeys) {
  std::vector<LegendEntry> entries{
      keyframe_entry(false, std::string(names::kGiven) + ", from 0"),
      keyframe_entry(true, std::string(names::kInserted)),
      quad_entry(palette::kGiven, plan.body_C.empty() ? "near quadrilateral" : "body"),
      line_entry(&stroke_before, plan.path_names.before),
      line_entry(&stroke_after, plan.path_names.after),
  };
  if (plan.body_C.empty()) entries.push_back(corner_entry());
  if (!plan.corrected.empty()) {
    entries.push_back(line_entry(&stroke_corrected, std::string(names::kCorrected)));
  }
  if (has_several_storeys) entries.push_back(line_entry(&stroke_elsewhere, "on another storey"));
  entries.push_back(collision_entry(false, std::string(names::kCollision) + " before"));
  entries.push_back(collision_entry(true, std::string(names::kCollision) + " that remains"));
  entries.push_back(quad_entry(palette::kCollision, "its begin and end"));
  if (plan.barrier) {
    entries.push_back(
        area_entry(kBarrierFill, palette::kInfeasible, std::string(names::kInfeasible)));
  }
  for (LegendEntry& entry : section_legend()) entries.push_back(std::move(entry));
  return entries;
}

double legend_height_px(std::size_t entries) {
  return kRow_px * std::ceil(static_cast<double>(entries) / kColumns);
}

void draw_legend(cairo_t* cr, const PlanPoint& corner, double width_px,
                 const std::vector<LegendEntry>& entries) {
  const std::size_t rows = (entries.size() + kColumns - 1) / kColumns;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const PlanPoint at =
        corner + PlanPoint(22.0 + width_px / kColumns * static_cast<double>(i / rows),
                           kRow_px * (0.5 + static_cast<double>(i % rows)));
    entries[i].draw_sample(cr, at);
    draw_text(cr, {at.x() + 30, at.y() + 0.36 * kLetters_px}, entries[i].text, kLetters_px,
              palette::kInk);
  }
}

}  // namespace camway::draw
