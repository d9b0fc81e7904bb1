// SPDX-License-Identifier: MIT
#pragma once

#include <cairo.h>

#include <string>
#include <vector>

#include "tools/drawing/floor_section.h"
#include "tools/drawing/palette.h"

/// Letters, lines and marks of pictures. Only the sources of this folder use them. Lengths on paper
/// are in pixels of a picture that is not enlarged.
namespace camway::draw {

/// A rectangle on paper. [Units: pixels]
struct Frame {
  double x, y, width, height;
};

using PlanBox = Eigen::AlignedBox2d;

/// Size of most letters. [Units: pixels]
inline constexpr double kLetters_px = 13.0;

void set_color(cairo_t* cr, const Color& color);

/// Strokes the current path.
void stroke(cairo_t* cr, const Color& color, double width_px);
/// Strokes the current path with dashes.
void stroke_dashed(cairo_t* cr, const Color& color, double width_px, double dash_px);

/// Draws text with a light rim, which keeps it legible on lines. `anchor` 0 is left-aligned, 0.5
/// centred, 1 right-aligned.
void draw_text(cairo_t* cr, const PlanPoint& at, const std::string& text, double size_px,
               const Color& color, double anchor = 0.0, bool bold = false);

/// Returns the width of a text as `draw_text` draws it.
double text_width_px(cairo_t* cr, const std::string& text, double size_px, bool bold = false);

/// Breaks a text between words into lines of about `width_px`.
std::vector<std::string> broken_into_lines(const std::string& text, double size_px,
                                           double width_px);

/// Draws the mark of a keyframe: a disc, or a lozenge if it was inserted.
void draw_keyframe_mark(cairo_t* cr, const PlanPoint& at, bool inserted);
/// Draws a wedge in the viewing direction on paper.
void draw_view_wedge(cairo_t* cr, const PlanPoint& at, double direction_rad, bool inserted);

/// Draws the mark of a collision: an open circle, with a cross if the collision remains.
void draw_collision_mark(cairo_t* cr, const PlanPoint& at, bool remains);

/// Draws a scale bar of 1, 2 or 5 times a power of ten that ends at `right`.
void draw_scale_bar(cairo_t* cr, const PlanPoint& right, double px_per_m);

/// Fill and line of the section of a barrier.
inline constexpr Color kBarrierFill = faded(palette::kInfeasible, 0.2);
inline constexpr double kBarrierLine_px = 2.6;

// The lines of each thing, the same in plans, height strips and legends.
void stroke_before(cairo_t* cr);
void stroke_after(cairo_t* cr);
void stroke_corrected(cairo_t* cr);
void stroke_collision(cairo_t* cr);
void stroke_elsewhere(cairo_t* cr);

}  // namespace camway::draw
