// SPDX-License-Identifier: MIT
#include "tools/drawing/height_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tools/drawing/axes.h"
#include "tools/drawing/floor_plan_view.h"
#include "tools/drawing/labels.h"

namespace camway::draw {
namespace {

/// A frame with time to the right and height upwards.
struct StripScale {
  Frame frame;
  PlanBox values;  ///< seconds and metres

  [[nodiscard]] PlanPoint to_px(double time_s, double height_m) const {
    const PlanPoint share =
        (PlanPoint(time_s, height_m) - values.min()).cwiseQuotient(values.sizes());
    return {frame.x + share.x() * frame.width, frame.y + (1.0 - share.y()) * frame.height};
  }
};

/// Returns times and heights of everything in the strip, with a margin of height.
PlanBox values_shown(const FloorPlan& plan, const std::vector<double>& floors_m) {
  constexpr double kLeastRange_m = 1.0;
  constexpr double kMargin = 0.12;
  PlanBox box;
  for (const SampledPath* path : {&plan.before, &plan.after}) {
    for (const PathSample& s : *path) {
      box.extend(PlanPoint(s.time_s, height_of(s.pose.position, plan.up)));
    }
  }
  for (const motion::Keyframe& k : plan.keyframes) {
    box.extend(PlanPoint(k.time_s, height_of(k.pose.position, plan.up)));
  }
  if (box.isEmpty()) box.extend(PlanPoint(0.0, 0.0));
  for (const double floor_m : floors_m) box.extend(PlanPoint(box.min().x(), floor_m));
  if (!(box.sizes().x() > 0.0)) box.extend(PlanPoint(box.min().x() + 1.0, box.min().y()));
  const double range_m = std::max(kLeastRange_m, (1.0 + 2 * kMargin) * box.sizes().y());
  const double more_m = (range_m - box.sizes().y()) / 2;
  box.extend(PlanPoint(box.min().x(), box.min().y() - more_m));
  box.extend(PlanPoint(box.min().x(), box.max().y() + more_m));
  return box;
}

void trace_heights(cairo_t* cr, const StripScale& scale, const SampledPath& path, SceneUp up) {
  for (const PathSample& s : path) {
    const PlanPoint p = scale.to_px(s.time_s, height_of(s.pose.position, up));
    cairo_line_to(cr, p.x(), p.y());
  }
}

/// Draws a band over the whole height of the strip, with hatches that show without colour.
void draw_band(cairo_t* cr, const StripScale& scale, double begin_s, double end_s) {
  constexpr double kLeastWidth_px = 3.0;
  constexpr double kHatch_px = 6.0;
  const Frame& frame = scale.frame;
  const double left = scale.to_px(begin_s, 0.0).x();
  const double width = std::max(kLeastWidth_px, scale.to_px(end_s, 0.0).x() - left);
  cairo_save(cr);
  cairo_rectangle(cr, left, frame.y, width, frame.height);
  set_color(cr, faded(palette::kCollision, 0.18));
  cairo_fill_preserve(cr);
  cairo_clip(cr);
  for (double y = frame.y - width; y < frame.y + frame.height; y += kHatch_px) {
    cairo_move_to(cr, left, y + width);
    cairo_line_to(cr, left + width, y);
  }
  stroke(cr, faded(palette::kCollision, 0.7), 0.8);
  cairo_restore(cr);
}

void draw_floors(cairo_t* cr, const StripScale& scale, const std::vector<double>& floors_m) {
  const double right = scale.frame.x + scale.frame.width;
  for (const double floor_m : floors_m) {
    const double y = scale.to_px(0.0, floor_m).y();
    cairo_move_to(cr, scale.frame.x, y);
    cairo_line_to(cr, right, y);
    stroke(cr, palette::kWall, 3.0);
  }
}

/// Draws what floors are called, where no label of a keyframe is.
void draw_floor_names(cairo_t* cr, const StripScale& scale, const std::vector<double>& floors_m,
                      LabelPlacer& places) {
  constexpr double kNameLetters_px = 11.5;
  const double right = scale.frame.x + scale.frame.width;
  for (const double floor_m : floors_m) {
    const std::string text = fmt::format("floor {:.2f} m", floor_m);
    const double width_px = text_width_px(cr, text, kNameLetters_px);
    const PlanPoint at(right - width_px / 2 - 4.0, scale.to_px(0.0, floor_m).y());
    const std::optional<PlanBox> box = places.place(at, {width_px, kNameLetters_px});
    if (!box) continue;
    draw_text(cr, {box->min().x(), box->max().y() - 1.5}, text, kNameLetters_px, palette::kInk);
  }
}

void draw_strip_paths(cairo_t* cr, const StripScale& scale, const FloorPlan& plan) {
  for (const TimeRange& range : plan.corrected) {
    cairo_new_sub_path(cr);
    trace_heights(cr, scale, part_of(plan.after, range.begin_s, range.end_s), plan.up);
  }
  stroke_corrected(cr);
  trace_heights(cr, scale, plan.before, plan.up);
  stroke_before(cr);
  trace_heights(cr, scale, plan.after, plan.up);
  stroke_after(cr);
  for (const bool remain : {false, true}) {
    const SampledPath& path = remain ? plan.after : plan.before;
    if (path.empty()) continue;
    for (const auto& interval : remain ? plan.remaining_collisions : plan.collisions) {
      const double middle_s = (interval.t_begin_s + interval.t_end_s) / 2;
      const double height_m = height_of(sample_at(path, middle_s).pose.position, plan.up);
      draw_collision_mark(cr, scale.to_px(middle_s, height_m), remain);
    }
  }
}

/// Draws marks and numbers of the keyframes.
void draw_strip_keyframes(cairo_t* cr, const StripScale& scale, const FloorPlan& plan,
                          LabelPlacer& places) {
  const std::vector<std::string> numbers = keyframe_numbers(plan.keyframes);
  std::vector<PlanPoint> marks;
  for (const motion::Keyframe& k : plan.keyframes) {
    marks.push_back(scale.to_px(k.time_s, height_of(k.pose.position, plan.up)));
    places.block(marks.back(), 5.0);
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {
    draw_keyframe_mark(cr, marks[i], numbers[i].empty());
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (numbers[i].empty()) continue;
    const double width_px = text_width_px(cr, numbers[i], kLetters_px, true);
    const std::optional<PlanBox> box = places.place(marks[i], {width_px, kLetters_px});
    if (!box) continue;
    draw_text(cr, {box->min().x(), box->max().y() - 1.5}, numbers[i], kLetters_px, palette::kInk,
              0.0, true);
  }
}

}  // namespace

void draw_height_strip(cairo_t* cr, const Frame& frame, const FloorPlan& plan,
                       const std::vector<double>& floors_m) {
  const StripScale scale{frame, values_shown(plan, floors_m)};
  draw_axes(cr, frame, {scale.values.min().x(), scale.values.max().x(), "time, s"},
            {scale.values.min().y(), scale.values.max().y(), height_name(plan.up) + ", m"}, true);
  cairo_save(cr);
  cairo_rectangle(cr, frame.x, frame.y, frame.width, frame.height);
  cairo_clip(cr);
  draw_floors(cr, scale, floors_m);
  for (const auto* intervals : {&plan.collisions, &plan.remaining_collisions}) {
    for (const collision::CollisionInterval& interval : *intervals) {
      draw_band(cr, scale, interval.t_begin_s, interval.t_end_s);
    }
  }
  draw_strip_paths(cr, scale, plan);
  cairo_restore(cr);
  // Marks at the ends of the path reach out of the frame.
  LabelPlacer places(frame);
  draw_strip_keyframes(cr, scale, plan, places);
  draw_floor_names(cr, scale, floors_m, places);
}

}  // namespace camway::draw
