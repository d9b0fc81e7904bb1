// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/drawing/floor_plan_view.h"
#include "tools/drawing/picture_file.h"

namespace camway::draw {
namespace {

constexpr double kMargin_px = 28.0;
constexpr double kTitle_px = 92.0;
constexpr double kLegend_px = 128.0;
constexpr double kDetailWidth_px = 400.0;
constexpr double kGap_px = 16.0;
constexpr std::size_t kMostDetails = 3;
constexpr double kLeastEnlargement = 1.6;  // below it a detail shows nothing new

/// Parts of the plan that are shown enlarged.
std::vector<PlanBox> places_of_collision(const FloorPlan& plan) {
  constexpr double kAround_m = 0.7;
  std::vector<PlanBox> places;
  for (const bool corrected : {false, true}) {
    const SampledPath& path = corrected ? plan.after : plan.before;
    if (path.empty()) continue;
    for (const collision::CollisionInterval& interval :
         corrected ? plan.remaining_collisions : plan.collisions) {
      PlanBox box;
      for (const double t : {interval.t_begin_s, interval.t_end_s}) {
        const PlanPoint p = to_plan(sample_at(path, t).pose.position, plan.up);
        box.extend(PlanPoint(p.array() - kAround_m));
        box.extend(PlanPoint(p.array() + kAround_m));
      }
      const auto near = std::find_if(places.begin(), places.end(), [&](const PlanBox& other) {
        return other.intersects(box) && other.merged(box).sizes().maxCoeff() < 6.0 * kAround_m;
      });
      if (near != places.end()) {
        near->extend(box);
      } else {
        places.push_back(box);
      }
    }
  }
  return places;
}

struct Layout {
  double width_px;
  double height_px;
  View main;
  std::vector<View> details;
};

/// Returns the layout, with a column of details at the right if there are `places`.
Layout lay_out_with(const FloorPlan& plan, const std::vector<PlanBox>& places) {
  const PlanBox world = world_shown(plan);
  Layout layout{plan.width_px, 0.0, {}, {}};
  const double column = places.empty() ? 0.0 : kDetailWidth_px + kGap_px;
  const double width = plan.width_px - 2 * kMargin_px - column;
  const double least = places.size() < 2 ? 430.0 : places.size() == 2 ? 640.0 : 860.0;
  const double height =
      std::clamp(width * world.sizes().y() / world.sizes().x(), least, std::max(least, 1050.0));
  layout.height_px = kTitle_px + height + kLegend_px;
  layout.main = fitted({kMargin_px, kTitle_px, width, height}, world);
  const auto count = static_cast<double>(places.size());
  const double detail_height = (height - (count - 1) * kGap_px) / std::max(count, 1.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Frame frame{kMargin_px + width + kGap_px,
                      kTitle_px + static_cast<double>(i) * (detail_height + kGap_px),
                      kDetailWidth_px, detail_height};
    layout.details.push_back(fitted(frame, places[i]));
  }
  return layout;
}

Layout lay_out(const FloorPlan& plan) {
  std::vector<PlanBox> places = places_of_collision(plan);
  places.resize(std::min(places.size(), kMostDetails));
  const Layout all = lay_out_with(plan, places);
  std::vector<PlanBox> worth_it;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (all.details[i].px_per_m >= kLeastEnlargement * all.main.px_per_m) {
      worth_it.push_back(places[i]);
    }
  }
  return worth_it.size() == places.size() ? all : lay_out_with(plan, worth_it);
}

std::string detail_name(std::size_t index) { return {static_cast<char>('A' + index)}; }

void draw_details(cairo_t* cr, const Layout& layout, const FloorPlan& plan,
                  const FloorSection& section) {
  for (std::size_t i = 0; i < layout.details.size(); ++i) {
    const View& detail = layout.details[i];
    draw_view(cr, detail, plan, section);
    char zoom[40];
    std::snprintf(zoom, sizeof zoom, "  (%.1f times larger)",
                  detail.px_per_m / layout.main.px_per_m);
    draw_text(cr, {detail.frame.x + 12, detail.frame.y + 26}, detail_name(i) + zoom, 17,
              palette::kInk, 0.0, true);
    const PlanPoint half =
        PlanPoint(detail.frame.width, detail.frame.height) / (2 * detail.px_per_m);
    // A narrow column would show more height than the plan has.
    const Frame& plan_frame = layout.main.frame;
    const PlanPoint begin(plan_frame.x, plan_frame.y);
    const PlanPoint end = begin + PlanPoint(plan_frame.width, plan_frame.height);
    const PlanPoint low = layout.main.to_px(detail.center - half).cwiseMax(begin);
    const PlanPoint high = layout.main.to_px(detail.center + half).cwiseMin(end);
    constexpr std::array kDashes{6.0, 4.0};
    cairo_set_dash(cr, kDashes.data(), static_cast<int>(kDashes.size()), 0.0);
    cairo_rectangle(cr, low.x(), low.y(), high.x() - low.x(), high.y() - low.y());
    set_color(cr, palette::kInk);
    cairo_set_line_width(cr, 1.3);
    cairo_stroke(cr);
    cairo_set_dash(cr, nullptr, 0, 0.0);
    draw_text(cr, {high.x() + 6, low.y() + 14}, detail_name(i), 17, palette::kInk, 0.0, true);
  }
}

void draw_line_sample(cairo_t* cr, const PlanPoint& at, const Color& color, double width_px) {
  cairo_move_to(cr, at.x() - 24, at.y());
  cairo_line_to(cr, at.x() + 24, at.y());
  set_color(cr, color);
  cairo_set_line_width(cr, width_px);
  cairo_stroke(cr);
}

void draw_quad_sample(cairo_t* cr, const PlanPoint& at, const Color& color) {
  cairo_rectangle(cr, at.x() - 18, at.y() - 4, 36, 8);
  set_color(cr, color);
  cairo_set_line_width(cr, 2.0);
  cairo_stroke(cr);
}

void draw_area_sample(cairo_t* cr, const PlanPoint& at, const Color& fill, const Color& rim) {
  cairo_rectangle(cr, at.x() - 22, at.y() - 7, 44, 14);
  set_color(cr, fill);
  cairo_fill_preserve(cr);
  set_color(cr, rim);
  cairo_set_line_width(cr, 1.3);
  cairo_stroke(cr);
}

/// Draws the legend: four columns of three samples with their meaning.
void draw_legend(cairo_t* cr, const Layout& layout, const FloorSection& section) {
  constexpr std::array kColumns{0.0, 390.0, 720.0, 1040.0};
  const double top = layout.height_px - kLegend_px + 40;
  const auto place = [&](std::size_t column, int row) {
    return PlanPoint(kMargin_px + 28 + kColumns[column], top + 34 * row);
  };
  const auto label = [&](std::size_t column, int row, const std::string& text) {
    draw_text(cr, place(column, row) + PlanPoint(34, 6), text, 16, palette::kInk);
  };
  draw_keyframe_mark(cr, place(0, 0) - PlanPoint(10, 0), 0.0, false);
  label(0, 0, "keyframe as given, looking to the right");
  draw_keyframe_mark(cr, place(0, 1) - PlanPoint(10, 0), 0.0, true);
  label(0, 1, "keyframe inserted by the correction");
  draw_quad_sample(cr, place(0, 2), palette::kInk);
  label(0, 2, "its near quadrilateral, from above");
  draw_line_sample(cr, place(1, 0), palette::kBefore, 2.0);
  label(1, 0, "path before, where it differs");
  draw_line_sample(cr, place(1, 1), palette::kAfter, 2.8);
  label(1, 1, "path after correction");
  draw_line_sample(cr, place(1, 2), {0.35, 0.53, 0.57, 0.7}, 1.0);
  label(1, 2, "curves of its four corners");
  draw_line_sample(cr, place(2, 0), palette::kCollision, 6.0);
  draw_collision_mark(cr, place(2, 0), false);
  label(2, 0, "collided before");
  draw_line_sample(cr, place(2, 1), palette::kCollision, 6.0);
  draw_collision_mark(cr, place(2, 1), true);
  label(2, 1, "still collides");
  draw_quad_sample(cr, place(2, 2), palette::kCollision);
  label(2, 2, "where it begins, ends");
  draw_area_sample(cr, place(3, 0), palette::kWallFill, palette::kWall);
  char text[80];
  std::snprintf(text, sizeof text, "cut at %.2f m", section.height_m);
  label(3, 0, text);
  draw_area_sample(cr, place(3, 1), palette::kTop, palette::kOutline);
  label(3, 1, "lower, above the floor");
}

/// Draws a scale bar and the two axes of the paper.
void draw_scale(cairo_t* cr, const Layout& layout, SceneUp up) {
  const double y = layout.height_px - kLegend_px + 46;
  const double right = layout.width_px - kMargin_px;
  draw_scale_bar(cr, {right, y}, layout.main.px_per_m, 17);
  draw_text(cr, {right, y + 40},
            up == SceneUp::kY ? "x to the right, z down" : "x to the right, y up", 15,
            palette::kMuted, 1.0);
}

void draw_all(cairo_t* cr, const Layout& layout, const FloorPlan& plan,
              const FloorSection& section) {
  draw_text(cr, {kMargin_px, 44}, plan.title, 28, palette::kInk, 0.0, true);
  draw_text(cr, {kMargin_px, 74}, plan.subtitle, 18, palette::kMuted);
  draw_view(cr, layout.main, plan, section);
  draw_details(cr, layout, plan, section);
  draw_legend(cr, layout, section);
  draw_scale(cr, layout, plan.up);
}

}  // namespace

SampledPath sample(const motion::Path& path, std::size_t count) {
  SampledPath samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(count - 1);
    const double time_s = path.begin_s() + s * (path.end_s() - path.begin_s());
    samples.push_back({time_s, path.pose(time_s)});
  }
  return samples;
}

double cut_height_m(const scene::Mesh& mesh, SceneUp up,
                    const std::vector<motion::Keyframe>& keyframes) {
  constexpr double kUsual_m = 1.5;      // above the floor: cuts doors and windows open
  constexpr double kTolerated_m = 0.7;  // up to here, being in the middle counts more
  constexpr std::size_t kMostTried = 9;
  std::vector<double> heights;
  for (const motion::Keyframe& k : keyframes) heights.push_back(height_of(k.pose.position, up));
  if (heights.empty()) return 0.0;
  std::sort(heights.begin(), heights.end());
  const double middle = heights[(heights.size() - 1) / 2];
  double best = middle;
  double best_penalty = HUGE_VAL;
  const std::size_t tried = std::min(heights.size(), kMostTried);
  for (std::size_t i = 0; i <= tried; ++i) {
    const double h =
        i == 0 ? middle
               : heights[(i - 1) * (heights.size() - 1) / std::max<std::size_t>(tried - 1, 1)];
    const double above_floor = h - find_floor_m(mesh, up, h);
    const double penalty = std::max(0.0, std::abs(above_floor - kUsual_m) - kTolerated_m);
    if (penalty < best_penalty) {
      best = h;
      best_penalty = penalty;
    }
  }
  return best;
}

namespace {

/// Returns the storey that the plan shows.
FloorSection section_of(const FloorPlan& plan) {
  return cut_floor(plan.mesh, plan.up,
                   plan.cut_height_m.value_or(cut_height_m(plan.mesh, plan.up, plan.keyframes)));
}

}  // namespace

std::string draw_floor_plan(const FloorPlan& plan, const PictureFiles& files) {
  const FloorSection section = section_of(plan);
  const Layout layout = lay_out(plan);
  return write_pictures(files, {layout.width_px, layout.height_px},
                        [&](cairo_t* cr) { draw_all(cr, layout, plan, section); });
}

std::string floor_plan_svg(const FloorPlan& plan) {
  const FloorSection section = section_of(plan);
  const Layout layout = lay_out(plan);
  return svg_picture({layout.width_px, layout.height_px},
                     [&](cairo_t* cr) { draw_all(cr, layout, plan, section); });
}

}  // namespace camway::draw
