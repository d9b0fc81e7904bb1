// SPDX-License-Identifier: MIT
#pragma once

#include <cairo.h>

#include <string>

#include "tools/drawing/floor_plan.h"

/// The inside of a floor plan's frames. Used by the sources of this folder only.
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

/// A rectangle on paper, pixels.
struct Frame {
  double x, y, width, height;
};

/// A window onto the plan: what part of the world is seen in which frame.
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

/// The keyframes and both paths, with a margin; the whole scene if there are none.
PlanBox world_shown(const FloorPlan& plan);

/// Returns the view of the whole `box`, as large as `frame` allows.
View fitted(const Frame& frame, const PlanBox& box);

void set_color(cairo_t* cr, const Color& color);
/// Text with a light rim, so that it stays legible on lines; `anchor` 0 left, 0.5 centred, 1 right.
void draw_text(cairo_t* cr, const PlanPoint& at, const std::string& text, double size_px,
               const Color& color, double anchor = 0.0, bool bold = false);

/// A keyframe's mark: a disc with a wedge in the viewing direction (radians on paper).
void draw_keyframe_mark(cairo_t* cr, const PlanPoint& at, double direction_rad, bool inserted);

/// A place of collision's mark: an open circle, with a cross if the correction did not mend it.
void draw_collision_mark(cairo_t* cr, const PlanPoint& at, bool remains);

/// A bar that ends at `right`, of 1, 2 or 5 times a power of ten metres, with its length above it.
void draw_scale_bar(cairo_t* cr, const PlanPoint& right, double px_per_m, double letters_px);

/// Scene, paths and keyframes in one view, with a border.
void draw_view(cairo_t* cr, const View& view, const FloorPlan& plan, const FloorSection& section);

/// Pose of `path` nearest in time to `time_s`. Precondition: not empty.
const PathSample& sample_at(const SampledPath& path, double time_s);

}  // namespace camway::draw
