// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace camway::draw {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kShortestEdge_px = 1.0;
constexpr std::size_t kFewPoints = 64;  // a line of so few is drawn with all of them

/// Whether a line through `points` may be visible in the frame.
template <typename Points>
bool is_seen(const View& view, const Points& points) {
  constexpr double kWidestLine_px = 8.0;
  PlanBox box;
  for (const PlanPoint& p : points) box.extend(view.to_px(p));
  const PlanPoint corner(view.frame.x - kWidestLine_px, view.frame.y - kWidestLine_px);
  const PlanPoint size(view.frame.width + 2 * kWidestLine_px,
                       view.frame.height + 2 * kWidestLine_px);
  return box.intersects(PlanBox(corner, corner + size));
}

/// Adds a line to the current path, unless it lies outside of the frame. Leaves out points that are
/// closer together than a line is wide.
void trace(cairo_t* cr, const View& view, const std::vector<PlanPoint>& points) {
  constexpr double kLeastStep_px = 2.5;
  if (points.empty() || !is_seen(view, points)) return;
  PlanPoint last = view.to_px(points.front());
  cairo_move_to(cr, last.x(), last.y());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const PlanPoint p = view.to_px(points[i]);
    if (i + 1 < points.size() && points.size() > kFewPoints && (p - last).norm() < kLeastStep_px) {
      continue;
    }
    cairo_line_to(cr, p.x(), p.y());
    last = p;
  }
}

void stroke(cairo_t* cr, const Color& color, double width_px) {
  set_color(cr, color);
  cairo_set_line_width(cr, width_px);
  cairo_stroke(cr);
}

double cross(const PlanPoint& a, const PlanPoint& b) { return a.x() * b.y() - a.y() * b.x(); }

void draw_scene(cairo_t* cr, const View& view, const FloorSection& section) {
  // All triangles get the same orientation. In one path, opposite orientations would cancel.
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
  for (const std::array<PlanPoint, 3>& top : section.tops) {
    if (!is_seen(view, top)) continue;
    const bool turns_left = cross(top[1] - top[0], top[2] - top[0]) > 0.0;
    trace(cr, view, {top[0], top[turns_left ? 1 : 2], top[turns_left ? 2 : 1]});
    cairo_close_path(cr);
  }
  set_color(cr, palette::kTop);
  cairo_fill(cr);
  for (const std::array<PlanPoint, 2>& edge : section.outlines) {
    if (view.px_per_m * (edge[1] - edge[0]).norm() < kShortestEdge_px) continue;
    trace(cr, view, {edge[0], edge[1]});
  }
  stroke(cr, palette::kOutline, 0.8);
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_EVEN_ODD);
  for (const std::vector<SectionLine>& object : section.cut) {
    for (const SectionLine& line : object) {
      if (line.closed) trace(cr, view, line.points);
    }
    set_color(cr, palette::kWallFill);
    cairo_fill(cr);
    for (const SectionLine& line : object) trace(cr, view, line.points);
    stroke(cr, palette::kWall, 1.3);
  }
}

std::vector<PlanPoint> quad_on_paper(const FloorPlan& plan, const motion::Pose& pose) {
  std::vector<PlanPoint> points;
  for (const geometry::Vec3& corner : motion::corners_W(plan.corners_C, pose)) {
    points.push_back(to_plan(corner, plan.up));
  }
  points.push_back(points.front());
  return points;
}

/// Draws the curve of the near quadrilateral's centre, and the corner curves.
void draw_path(cairo_t* cr, const View& view, const FloorPlan& plan, const SampledPath& path,
               const Color& color, double width_px) {
  Color light = color;
  light.alpha = 0.55;
  for (const geometry::Vec3& corner_C : plan.corners_C) {
    std::vector<PlanPoint> curve;
    for (const PathSample& s : path) {
      curve.push_back(to_plan(s.pose.position + s.pose.orientation * corner_C, plan.up));
    }
    trace(cr, view, curve);
  }
  stroke(cr, light, 0.5 * width_px);
  std::vector<PlanPoint> middle;
  for (const PathSample& s : path) middle.push_back(to_plan(s.pose.position, plan.up));
  trace(cr, view, middle);
  stroke(cr, color, width_px);
}

void draw_collisions(cairo_t* cr, const View& view, const FloorPlan& plan, const SampledPath& path,
                     const std::vector<collision::CollisionInterval>& intervals, bool remain) {
  if (path.empty()) return;
  for (const collision::CollisionInterval& interval : intervals) {
    std::vector<PlanPoint> line{
        to_plan(sample_at(path, interval.t_begin_s).pose.position, plan.up)};
    for (const PathSample& s : path) {
      if (s.time_s > interval.t_begin_s && s.time_s < interval.t_end_s) {
        line.push_back(to_plan(s.pose.position, plan.up));
      }
    }
    line.push_back(to_plan(sample_at(path, interval.t_end_s).pose.position, plan.up));
    trace(cr, view, line);
    stroke(cr, palette::kCollision, 6.0);
    for (const double end_s : {interval.t_begin_s, interval.t_end_s}) {
      trace(cr, view, quad_on_paper(plan, sample_at(path, end_s).pose));
      stroke(cr, palette::kCollision, 1.8);
    }
    const double middle_s = (interval.t_begin_s + interval.t_end_s) / 2;
    draw_collision_mark(cr, view.to_px(to_plan(sample_at(path, middle_s).pose.position, plan.up)),
                        remain);
  }
}

void draw_keyframes(cairo_t* cr, const View& view, const FloorPlan& plan) {
  int given = 0;
  for (const motion::Keyframe& keyframe : plan.keyframes) {
    const bool inserted = keyframe.origin == motion::KeyframeOrigin::kInserted;
    trace(cr, view, quad_on_paper(plan, keyframe.pose));
    stroke(cr, inserted ? palette::kInserted : palette::kInk, 2.0);
    const PlanPoint eye = view.to_px(to_plan(keyframe.pose.position, plan.up));
    const geometry::Vec3 forward_W = keyframe.pose.orientation * geometry::Vec3(0.0, 0.0, -1.0);
    const PlanPoint forward = to_plan(forward_W, plan.up);
    draw_keyframe_mark(cr, eye, std::atan2(forward.y(), forward.x()), inserted);
    if (!inserted) {
      draw_text(cr, eye + PlanPoint(0.0, -13.0), std::to_string(++given), 17.0, palette::kInk, 0.5,
                true);
    }
  }
}

}  // namespace

PlanBox world_shown(const FloorPlan& plan) {
  PlanBox box;
  for (const motion::Keyframe& k : plan.keyframes) box.extend(to_plan(k.pose.position, plan.up));
  for (const SampledPath* path : {&plan.before, &plan.after}) {
    for (const PathSample& s : *path) box.extend(to_plan(s.pose.position, plan.up));
  }
  if (box.isEmpty()) {
    for (const geometry::Vec3& vertex : plan.mesh.vertices) box.extend(to_plan(vertex, plan.up));
  }
  if (box.isEmpty()) box.extend(PlanPoint(0.0, 0.0));
  const double margin_m = std::max(1.6, 0.1 * box.sizes().maxCoeff());
  return {PlanPoint(box.min().array() - margin_m), PlanPoint(box.max().array() + margin_m)};
}

View fitted(const Frame& frame, const PlanBox& box) {
  const PlanPoint size = box.sizes();
  return {frame, box.center(), std::min(frame.width / size.x(), frame.height / size.y())};
}

void set_color(cairo_t* cr, const Color& c) {
  cairo_set_source_rgba(cr, c.red, c.green, c.blue, c.alpha);
}

void draw_text(cairo_t* cr, const PlanPoint& at, const std::string& text, double size_px,
               const Color& color, double anchor, bool bold) {
  cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size_px);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  cairo_move_to(cr, at.x() - anchor * extents.x_advance, at.y());
  cairo_text_path(cr, text.c_str());
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cr, 3.5);
  set_color(cr, {1.0, 1.0, 1.0, 0.9});
  cairo_stroke_preserve(cr);
  set_color(cr, color);
  cairo_fill(cr);
}

void draw_keyframe_mark(cairo_t* cr, const PlanPoint& at, double direction_rad, bool inserted) {
  const double wedge_px = inserted ? 18.0 : 26.0;
  constexpr double kHalfAngle = 0.4;
  const Color color = inserted ? palette::kInserted : palette::kInk;
  cairo_new_path(cr);
  cairo_move_to(cr, at.x(), at.y());
  cairo_arc(cr, at.x(), at.y(), wedge_px, direction_rad - kHalfAngle, direction_rad + kHalfAngle);
  cairo_close_path(cr);
  set_color(cr, {color.red, color.green, color.blue, 0.28});
  cairo_fill(cr);
  if (inserted) {  // a lozenge, not only another colour
    cairo_move_to(cr, at.x(), at.y() - 7.5);
    cairo_line_to(cr, at.x() + 7.5, at.y());
    cairo_line_to(cr, at.x(), at.y() + 7.5);
    cairo_line_to(cr, at.x() - 7.5, at.y());
    cairo_close_path(cr);
  } else {
    cairo_arc(cr, at.x(), at.y(), 5.5, 0.0, kFullTurn);
  }
  set_color(cr, color);
  cairo_fill_preserve(cr);
  stroke(cr, {1.0, 1.0, 1.0}, 1.2);
}

void draw_collision_mark(cairo_t* cr, const PlanPoint& at, bool remains) {
  constexpr double kRadiusPx = 12.0;
  cairo_new_path(cr);
  cairo_arc(cr, at.x(), at.y(), kRadiusPx, 0.0, kFullTurn);
  if (remains) {
    const double arm = kRadiusPx * std::numbers::sqrt2 / 2.0;
    for (const double side : {-1.0, 1.0}) {
      cairo_move_to(cr, at.x() - arm, at.y() - side * arm);
      cairo_line_to(cr, at.x() + arm, at.y() + side * arm);
    }
  }
  stroke(cr, palette::kCollision, 2.6);
}

void draw_scale_bar(cairo_t* cr, const PlanPoint& right, double px_per_m, double letters_px) {
  constexpr double kLongest_px = 190.0;
  const double most_m = kLongest_px / px_per_m;
  const double decade_m = std::pow(10.0, std::floor(std::log10(most_m)));
  const double length_m = decade_m * (most_m >= 5 * decade_m ? 5 : most_m >= 2 * decade_m ? 2 : 1);
  const double left = right.x() - length_m * px_per_m;
  set_color(cr, palette::kInk);
  cairo_set_line_width(cr, 2.5);
  for (const double x : {left, right.x()}) {
    cairo_move_to(cr, x, right.y() - 7);
    cairo_line_to(cr, x, right.y() + 7);
  }
  cairo_move_to(cr, left, right.y());
  cairo_line_to(cr, right.x(), right.y());
  cairo_stroke(cr);
  char text[40];
  std::snprintf(text, sizeof text, "%g m", length_m);
  draw_text(cr, {(left + right.x()) / 2, right.y() - 12}, text, letters_px, palette::kInk, 0.5);
}

const PathSample& sample_at(const SampledPath& path, double time_s) {
  return *std::min_element(path.begin(), path.end(), [&](const PathSample& a, const PathSample& b) {
    return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
  });
}

void draw_view(cairo_t* cr, const View& view, const FloorPlan& plan, const FloorSection& section) {
  cairo_save(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  cairo_clip(cr);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  draw_scene(cr, view, section);
  draw_path(cr, view, plan, plan.before, palette::kBefore, 2.0);
  draw_path(cr, view, plan, plan.after, palette::kAfter, 2.8);
  draw_collisions(cr, view, plan, plan.before, plan.collisions, false);
  draw_collisions(cr, view, plan, plan.after, plan.remaining_collisions, true);
  draw_keyframes(cr, view, plan);
  cairo_restore(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  stroke(cr, palette::kMuted, 1.0);
}

}  // namespace camway::draw
