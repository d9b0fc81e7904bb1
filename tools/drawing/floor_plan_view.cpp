// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/drawing/labels.h"

namespace camway::draw {
namespace {

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

double cross(const PlanPoint& a, const PlanPoint& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the convex hull of points, closed: its first point comes again at the end. Andrew's
/// monotone chain (1979).
std::vector<PlanPoint> hull_of(std::vector<PlanPoint> points) {
  std::ranges::sort(points, [](const PlanPoint& a, const PlanPoint& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<PlanPoint> hull;
  const auto add_chain = [&] {
    const std::size_t begin = hull.size();
    for (const PlanPoint& p : points) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // the first point of the other chain
  };
  add_chain();
  std::ranges::reverse(points);
  add_chain();
  if (hull.empty()) hull = {points.front()};
  hull.push_back(hull.front());
  return hull;
}

/// Returns the outline of the body's convex hull, closed.
std::vector<PlanPoint> body_on_paper(const FloorPlan& plan, const motion::Pose& pose) {
  constexpr int kCirclePoints = 32;
  std::vector<PlanPoint> points;
  for (const geometry::Vec3& point_C : plan.body_C) {
    const PlanPoint at = to_plan(pose.position + pose.orientation * point_C, plan.up);
    points.push_back(at);
    for (int i = 0; i < kCirclePoints && plan.body_ball_m > 0.0; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kCirclePoints;
      points.push_back(at + plan.body_ball_m * PlanPoint(std::cos(angle_rad), std::sin(angle_rad)));
    }
  }
  return hull_of(std::move(points));
}

std::vector<PlanPoint> line_of(const SampledPath& path, SceneUp up) {
  std::vector<PlanPoint> line;
  for (const PathSample& s : path) line.push_back(to_plan(s.pose.position, up));
  return line;
}

/// Traces the curves of the four corners of a near quadrilateral.
void trace_corners(cairo_t* cr, const View& view, const FloorPlan& plan,
                   const std::vector<SampledPath>& pieces) {
  if (!plan.body_C.empty()) return;
  for (const SampledPath& piece : pieces) {
    for (const geometry::Vec3& corner_C : plan.corners_C) {
      std::vector<PlanPoint> curve;
      for (const PathSample& s : piece) {
        curve.push_back(to_plan(s.pose.position + s.pose.orientation * corner_C, plan.up));
      }
      trace(cr, view, curve);
    }
  }
}

void trace_all(cairo_t* cr, const View& view, SceneUp up, const std::vector<SampledPath>& pieces) {
  for (const SampledPath& piece : pieces) trace(cr, view, line_of(piece, up));
}

void draw_paths(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel) {
  constexpr double kCornerAlpha = 0.5;
  const bool has_after = !plan.after.empty();
  trace_all(cr, view, plan.up, has_after ? panel.after.elsewhere : panel.before.elsewhere);
  stroke_elsewhere(cr);
  trace_all(cr, view, plan.up, panel.corrected);
  stroke_corrected(cr);
  trace_corners(cr, view, plan, panel.before.here);
  stroke(cr, faded(palette::kBefore, kCornerAlpha), 0.9);
  trace_all(cr, view, plan.up, panel.before.here);
  stroke_before(cr);
  trace_corners(cr, view, plan, panel.after.here);
  stroke(cr, faded(palette::kAfter, kCornerAlpha), 0.9);
  trace_all(cr, view, plan.up, panel.after.here);
  stroke_after(cr);
}

void draw_barrier(cairo_t* cr, const View& view, const Panel& panel) {
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_EVEN_ODD);
  for (const SectionLine& line : panel.barrier) {
    if (line.closed) trace(cr, view, line.points);
  }
  set_color(cr, kBarrierFill);
  cairo_fill(cr);
  for (const SectionLine& line : panel.barrier) trace(cr, view, line.points);
  stroke(cr, palette::kInfeasible, kBarrierLine_px);
}

PlanPoint middle_of(const PanelCollision& collision, SceneUp up) {
  return to_plan(sample_at(collision.path, collision.middle_s).pose.position, up);
}

void draw_collisions(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel) {
  for (const PanelCollision& collision : panel.collisions) {
    if (collision.path.empty()) continue;
    trace(cr, view, line_of(collision.path, plan.up));
    stroke_collision(cr);
    for (const PathSample* end : {&collision.path.front(), &collision.path.back()}) {
      trace(cr, view, outline_on_paper(plan, end->pose));
      stroke(cr, palette::kCollision, 1.5);
    }
    draw_collision_mark(cr, view.to_px(middle_of(collision, plan.up)), collision.remains);
  }
}

/// Returns the viewing direction on paper, of unit length unless the camera looks straight up or
/// down.
PlanPoint direction_on_paper(const motion::Pose& pose, SceneUp up) {
  return to_plan(pose.orientation * geometry::Vec3(0.0, 0.0, -1.0), up).normalized();
}

void draw_keyframes(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel) {
  for (const PanelKeyframe& keyframe : panel.keyframes) {
    trace(cr, view, outline_on_paper(plan, keyframe.pose));
    stroke(cr, keyframe.is_inserted ? palette::kInserted : palette::kGiven, 1.6);
    const PlanPoint forward = direction_on_paper(keyframe.pose, plan.up);
    draw_view_wedge(cr, view.to_px(to_plan(keyframe.pose.position, plan.up)),
                    std::atan2(forward.y(), forward.x()), keyframe.is_inserted);
  }
  for (const PanelKeyframe& keyframe : panel.keyframes) {
    draw_keyframe_mark(cr, view.to_px(to_plan(keyframe.pose.position, plan.up)),
                       keyframe.is_inserted);
  }
}

/// Draws numbers and remarks beside keyframes where there is room, else the numbers alone.
void draw_keyframe_labels(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel,
                          const std::vector<PlanBox>& kept_clear) {
  constexpr double kWedgeMiddle_px = 12.0;
  LabelPlacer places(view.frame);
  for (const PlanBox& box : kept_clear) places.block(box);
  for (const PanelCollision& collision : panel.collisions) {
    if (!collision.path.empty()) places.block(view.to_px(middle_of(collision, plan.up)), 9.0);
  }
  for (const PanelKeyframe& keyframe : panel.keyframes) {
    const PlanPoint at = view.to_px(to_plan(keyframe.pose.position, plan.up));
    places.block(at, 5.0);
    places.block(at + kWedgeMiddle_px * direction_on_paper(keyframe.pose, plan.up), 6.0);
  }
  for (const PanelKeyframe& keyframe : panel.keyframes) {
    if (keyframe.number.empty()) continue;
    const PlanPoint at = view.to_px(to_plan(keyframe.pose.position, plan.up));
    const double number_px = text_width_px(cr, keyframe.number, kLetters_px, true);
    const std::string remark = keyframe.remark.empty() ? "" : " (" + keyframe.remark + ")";
    const double remark_px = text_width_px(cr, remark, kLetters_px - 2);
    std::optional<PlanBox> box = places.place(at, {number_px + remark_px, kLetters_px});
    const bool is_whole = box.has_value();
    if (!box) box = places.place(at, {number_px, kLetters_px});
    if (!box) continue;
    const PlanPoint foot(box->min().x(), box->max().y() - 1.5);
    draw_text(cr, foot, keyframe.number, kLetters_px, palette::kInk, 0.0, true);
    if (!is_whole) continue;
    draw_text(cr, {foot.x() + number_px, foot.y()}, remark, kLetters_px - 2, palette::kInk);
  }
}

}  // namespace

std::vector<PlanPoint> outline_on_paper(const FloorPlan& plan, const motion::Pose& pose) {
  if (!plan.body_C.empty()) return body_on_paper(plan, pose);
  std::vector<PlanPoint> points;
  for (const geometry::Vec3& corner : motion::corners_W(plan.corners_C, pose)) {
    points.push_back(to_plan(corner, plan.up));
  }
  points.push_back(points.front());
  return points;
}

void draw_section(cairo_t* cr, const View& view, const FloorSection& section) {
  cairo_save(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  cairo_clip(cr);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
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
  cairo_restore(cr);
}

PlanBox bounds_on_paper(const scene::Mesh& mesh, SceneUp up) {
  PlanBox box;
  for (const geometry::Vec3& vertex : mesh.vertices) box.extend(to_plan(vertex, up));
  return box;
}

PlanBox world_shown(const FloorPlan& plan) {
  PlanBox box;
  for (const motion::Keyframe& k : plan.keyframes) box.extend(to_plan(k.pose.position, plan.up));
  for (const SampledPath* path : {&plan.before, &plan.after}) {
    for (const PathSample& s : *path) box.extend(to_plan(s.pose.position, plan.up));
  }
  if (plan.barrier) {
    const scene::Mesh& surface = plan.barrier->surface;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      for (const geometry::Vec3& corner : surface.triangle(i)) {
        box.extend(to_plan(corner, plan.up));
      }
    }
  }
  if (box.isEmpty()) box = bounds_on_paper(plan.mesh, plan.up);
  if (box.isEmpty()) box.extend(PlanPoint(0.0, 0.0));
  const double margin_m = std::max(1.6, 0.1 * box.sizes().maxCoeff());
  return {PlanPoint(box.min().array() - margin_m), PlanPoint(box.max().array() + margin_m)};
}

View fitted(const Frame& frame, const PlanBox& box) {
  const PlanPoint size = box.sizes();
  return {frame, box.center(), std::min(frame.width / size.x(), frame.height / size.y())};
}

void draw_view(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel,
               const std::vector<PlanBox>& kept_clear) {
  draw_section(cr, view, panel.section);
  cairo_save(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  cairo_clip(cr);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  draw_barrier(cr, view, panel);
  draw_paths(cr, view, plan, panel);
  draw_collisions(cr, view, plan, panel);
  draw_keyframes(cr, view, plan, panel);
  draw_keyframe_labels(cr, view, plan, panel, kept_clear);
  cairo_restore(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  stroke(cr, palette::kMuted, 1.0);
}

void draw_plan_axes(cairo_t* cr, const View& view, SceneUp up, bool has_grid) {
  const PlanPoint half = PlanPoint(view.frame.width, view.frame.height) / (2 * view.px_per_m);
  const PlanPoint low = view.center - half;
  const PlanPoint high = view.center + half;
  // Paper runs down: as z does where y points up, and against y where z does.
  const Axis upward =
      up == SceneUp::kY ? Axis{high.y(), low.y(), "z, m"} : Axis{-high.y(), -low.y(), "y, m"};
  draw_axes(cr, view.frame, {low.x(), high.x(), "x, m"}, upward, has_grid);
}

std::string height_name(SceneUp up) { return up == SceneUp::kY ? "y" : "z"; }

}  // namespace camway::draw
