// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/drawing/axes.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/marks.h"
#include "tools/drawing/storey_panels.h"

/// The drawing inside the frames of a floor plan. Only the sources of this folder use it.
namespace camway::draw {

/// A frame and the part of the plan that is drawn in it.
struct View {
  Frame frame;
  PlanPoint center = PlanPoint::Zero();
  double px_per_m = 1.0;

  [[nodiscard]] PlanPoint to_px(const PlanPoint& p) const {
    const PlanPoint middle(frame.x + frame.width / 2, frame.y + frame.height / 2);
    return middle + px_per_m * (p - center);
  }
};

/// Returns the bounds of all paths and keyframes, with a margin; of the scene if there are none.
PlanBox world_shown(const FloorPlan& plan);
/// Returns the bounds of a scene on paper.
PlanBox bounds_on_paper(const scene::Mesh& mesh, SceneUp up);

/// Returns the view of the whole `box`, as large as `frame` allows.
View fitted(const Frame& frame, const PlanBox& box);

/// Returns the outline of the near quadrilateral at a pose, or of the convex hull of the body in
/// place of it. Its first point comes again at the end.
std::vector<PlanPoint> outline_on_paper(const FloorPlan& plan, const motion::Pose& pose);

/// Draws the section of a scene, without a border.
void draw_section(cairo_t* cr, const View& view, const FloorSection& section);

/// Draws the scene, paths and keyframes of a panel in one view, with a border. Labels of keyframes
/// keep clear of the boxes `kept_clear`. [Units: pixels]
void draw_view(cairo_t* cr, const View& view, const FloorPlan& plan, const Panel& panel,
               const std::vector<PlanBox>& kept_clear = {});

/// Draws the border of a view and its axes, which have the names of coordinates.
void draw_plan_axes(cairo_t* cr, const View& view, SceneUp up, bool has_grid);

/// Returns the name of the coordinate that is the height.
std::string height_name(SceneUp up);

}  // namespace camway::draw
