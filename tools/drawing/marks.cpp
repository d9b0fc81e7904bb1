// SPDX-License-Identifier: MIT
#include "tools/drawing/marks.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace camway::draw {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

void choose_font(cairo_t* cr, double size_px, bool bold) {
  cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size_px);
}

}  // namespace

void set_color(cairo_t* cr, const Color& c) {
  cairo_set_source_rgba(cr, c.red, c.green, c.blue, c.alpha);
}

void stroke(cairo_t* cr, const Color& color, double width_px) {
  set_color(cr, color);
  cairo_set_line_width(cr, width_px);
  cairo_stroke(cr);
}

void stroke_dashed(cairo_t* cr, const Color& color, double width_px, double dash_px) {
  const double dashes[] = {dash_px, 0.8 * dash_px};
  cairo_save(cr);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(cr, dashes, 2, 0.0);
  stroke(cr, color, width_px);
  cairo_restore(cr);
}

void draw_text(cairo_t* cr, const PlanPoint& at, const std::string& text, double size_px,
               const Color& color, double anchor, bool bold) {
  choose_font(cr, size_px, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  cairo_move_to(cr, at.x() - anchor * extents.x_advance, at.y());
  cairo_text_path(cr, text.c_str());
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cr, 3.0);
  set_color(cr, {1.0, 1.0, 1.0, 0.9});
  cairo_stroke_preserve(cr);
  set_color(cr, color);
  cairo_fill(cr);
}

double text_width_px(cairo_t* cr, const std::string& text, double size_px, bool bold) {
  choose_font(cr, size_px, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  return extents.x_advance;
}

std::vector<std::string> broken_into_lines(const std::string& text, double size_px,
                                           double width_px) {
  constexpr double kLetterWidth = 0.56;  // of the size, about the mean of DejaVu Sans
  const auto most = static_cast<std::size_t>(width_px / (kLetterWidth * size_px));
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.empty() && lines.back().size() + 1 + word.size() <= most) {
      lines.back() += ' ' + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

void draw_view_wedge(cairo_t* cr, const PlanPoint& at, double direction_rad, bool inserted) {
  const double length_px = inserted ? 14.0 : 20.0;
  constexpr double kHalfAngle_rad = 0.4;
  cairo_new_path(cr);
  cairo_move_to(cr, at.x(), at.y());
  cairo_arc(cr, at.x(), at.y(), length_px, direction_rad - kHalfAngle_rad,
            direction_rad + kHalfAngle_rad);
  cairo_close_path(cr);
  set_color(cr, faded(inserted ? palette::kInserted : palette::kGiven, 0.28));
  cairo_fill(cr);
}

void draw_keyframe_mark(cairo_t* cr, const PlanPoint& at, bool inserted) {
  cairo_new_path(cr);
  if (inserted) {  // a lozenge, not only another colour
    constexpr double kHalf_px = 5.5;
    cairo_move_to(cr, at.x(), at.y() - kHalf_px);
    cairo_line_to(cr, at.x() + kHalf_px, at.y());
    cairo_line_to(cr, at.x(), at.y() + kHalf_px);
    cairo_line_to(cr, at.x() - kHalf_px, at.y());
    cairo_close_path(cr);
  } else {
    constexpr double kRadius_px = 4.5;
    cairo_arc(cr, at.x(), at.y(), kRadius_px, 0.0, kFullTurn);
  }
  set_color(cr, inserted ? palette::kInserted : palette::kGiven);
  cairo_fill_preserve(cr);
  stroke(cr, {1.0, 1.0, 1.0}, 1.0);
}

void draw_collision_mark(cairo_t* cr, const PlanPoint& at, bool remains) {
  constexpr double kRadius_px = 9.0;
  cairo_new_path(cr);
  cairo_arc(cr, at.x(), at.y(), kRadius_px, 0.0, kFullTurn);
  if (remains) {
    const double arm = kRadius_px * std::numbers::sqrt2 / 2.0;
    for (const double side : {-1.0, 1.0}) {
      cairo_move_to(cr, at.x() - arm, at.y() - side * arm);
      cairo_line_to(cr, at.x() + arm, at.y() + side * arm);
    }
  }
  stroke(cr, palette::kCollision, 2.2);
}

void draw_scale_bar(cairo_t* cr, const PlanPoint& right, double px_per_m) {
  constexpr double kLongest_px = 150.0;
  const double most_m = kLongest_px / px_per_m;
  const double decade_m = std::pow(10.0, std::floor(std::log10(most_m)));
  const double length_m = decade_m * (most_m >= 5 * decade_m ? 5 : most_m >= 2 * decade_m ? 2 : 1);
  const double left = right.x() - length_m * px_per_m;
  for (const double x : {left, right.x()}) {
    cairo_move_to(cr, x, right.y() - 5);
    cairo_line_to(cr, x, right.y() + 5);
  }
  cairo_move_to(cr, left, right.y());
  cairo_line_to(cr, right.x(), right.y());
  stroke(cr, palette::kInk, 2.0);
  draw_text(cr, {(left + right.x()) / 2, right.y() - 6}, fmt::format("{:g} m", length_m),
            kLetters_px, palette::kInk, 0.5);
}

void stroke_before(cairo_t* cr) { stroke_dashed(cr, palette::kBefore, 2.2, 7.0); }
void stroke_after(cairo_t* cr) { stroke(cr, palette::kAfter, 2.2); }
void stroke_corrected(cairo_t* cr) { stroke(cr, faded(palette::kCorrected, 0.6), 8.0); }
void stroke_collision(cairo_t* cr) { stroke(cr, palette::kCollision, 4.5); }
void stroke_elsewhere(cairo_t* cr) { stroke_dashed(cr, palette::kMuted, 1.0, 2.0); }

}  // namespace camway::draw
