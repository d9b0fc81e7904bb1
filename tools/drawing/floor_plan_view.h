// SPDX-License-Identifier: MIT
#pragma once

#include <cairo.h>

#include <string>

#include "tools/drawing/floor_plan.h"

/// The drawing inside the frames of a floor plan. Only the sources of this folder use it.
namespace camway::draw {

struct Color {
  double red, green, blue;
  double alpha = 1.0;
};

namespace palette {
constexpr Color kInk{0.13, 0.13, 0.13};
constexpr Color kMuted{0.42, 0.42, 0.42};
constexpr Color kWall{0.45, 0.45, 0.45};
constexpr Color kWallFill{0.78, 0.78, 0.78};
constexpr Color kTop{0.95, 0.945, 0.93};
constexpr Color kOutline{0.70, 0.69, 0.67};
constexpr Color kBefore{0.0, 0.447, 0.698};     // blue
constexpr Color kAfter{0.0, 0.62, 0.451};       // bluish green
constexpr Color kCollision{0.835, 0.369, 0.0};  // vermilion
constexpr Color kInserted{0.8, 0.475, 0.655};   // reddish purple
}  // namespace palette

/// A rectangle on paper. [Units: pixels]
struct Frame {
  double x, y, width, height;
};

/// A frame and the part of the plan that is drawn in it.
struct View {
  Frame frame;
  PlanPoint center;
  double px_per_m;

  [[nodiscard]] PlanPoint to_px(const PlanPoint& p) const {
    const PlanPoint middle(frame.x + frame.width / 2, frame.y + frame.height / 2);
    return middle + px_per_m * (p - center);
  }
};

using PlanBox = Eigen::AlignedBox2d;

/// Returns the bounds of all paths and keyframes, with a margin; of the scene if there are none.
PlanBox world_shown(const FloorPlan& plan);

/// Returns the view of the whole `box`, as large as `frame` allows.
View fitted(const Frame& frame, const PlanBox& box);

void set_color(cairo_t* cr, const Color& color);
/// Draws text with a light rim, which keeps it legible on lines. `anchor` 0 is left-aligned, 0.5
/// centred, 1 right-aligned.
void draw_text(cairo_t* cr, const PlanPoint& at, const std::string& text, double size_px,
               const Color& color, double anchor = 0.0, bool bold = false);

/// Draws the mark of a keyframe: a disc with a wedge in the viewing direction on paper.
void draw_keyframe_mark(cairo_t* cr, const PlanPoint& at, double direction_rad, bool inserted);

/// Draws the mark of a collision: an open circle, with a cross if the collision remains.
void draw_collision_mark(cairo_t* cr, const PlanPoint& at, bool remains);

/// Draws a scale bar of 1, 2 or 5 times a power of ten that ends at `right`.
void draw_scale_bar(cairo_t* cr, const PlanPoint& right, double px_per_m, double letters_px);

/// Draws scene, paths and keyframes in one view, with a border.
void draw_view(cairo_t* cr, const View& view, const FloorPlan& plan, const FloorSection& section);

/// Returns the sample of `path` nearest in time to `time_s`. Requires a path that is not empty.
const PathSample& sample_at(const SampledPath& path, double time_s);

}  // namespace camway::draw
