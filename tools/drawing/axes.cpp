// SPDX-License-Identifier: MIT
#include "tools/drawing/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace camway::draw {
namespace {

constexpr double kTick_px = 5.0;
constexpr double kTickLetters_px = 11.5;

/// Returns the smallest round step of which at most `most` fit into `range`.
double round_step(double range, std::size_t most) {
  const double least = range / static_cast<double>(most - 1);
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) return factor * decade;
  }
  return 10.0 * decade;
}

/// Formats a tick with the decimals that its neighbours differ in.
std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 0.01)));
  return fmt::format("{:.{}f}", value, decimals);
}

double step_of(const std::vector<double>& values) {
  return values.size() < 2 ? 1.0 : values[1] - values[0];
}

void line(cairo_t* cr, double x0, double y0, double x1, double y1) {
  cairo_move_to(cr, x0, y0);
  cairo_line_to(cr, x1, y1);
}

std::size_t most_ticks(double length_px, double each_px) {
  return std::max<std::size_t>(2, static_cast<std::size_t>(length_px / each_px));
}

void draw_across(cairo_t* cr, const Frame& frame, const Axis& axis, bool has_grid) {
  const double bottom = frame.y + frame.height;
  const double right = frame.x + frame.width;
  const std::vector<double> values = ticks(axis, most_ticks(frame.width, 46.0));
  const double name_from =
      right - text_width_px(cr, axis.name, kTickLetters_px, true) - 0.5 * kTickLetters_px;
  for (const double value : values) {
    const double x = frame.x + (value - axis.begin) / (axis.end - axis.begin) * frame.width;
    if (has_grid) {
      line(cr, x, frame.y, x, bottom);
      stroke(cr, faded(palette::kGrid, 0.9), 0.7);
    }
    line(cr, x, bottom, x, bottom + kTick_px);
    stroke(cr, palette::kInk, 1.0);
    const std::string text = tick_text(value, step_of(values));
    if (x + text_width_px(cr, text, kTickLetters_px) / 2 > name_from) continue;
    draw_text(cr, {x, bottom + kTick_px + kTickLetters_px}, text, kTickLetters_px, palette::kInk,
              0.5);
  }
  draw_text(cr, {right, bottom + kTick_px + kTickLetters_px}, axis.name, kTickLetters_px,
            palette::kInk, 1.0, true);
}

void draw_upward(cairo_t* cr, const Frame& frame, const Axis& axis, bool has_grid) {
  const double bottom = frame.y + frame.height;
  const std::vector<double> values = ticks(axis, most_ticks(frame.height, 30.0));
  for (const double value : values) {
    const double y = bottom - (value - axis.begin) / (axis.end - axis.begin) * frame.height;
    if (has_grid) {
      line(cr, frame.x, y, frame.x + frame.width, y);
      stroke(cr, faded(palette::kGrid, 0.9), 0.7);
    }
    line(cr, frame.x - kTick_px, y, frame.x, y);
    stroke(cr, palette::kInk, 1.0);
    // The name stands above the highest place for a number.
    if (y - frame.y < 0.5 * kTickLetters_px) continue;
    draw_text(cr, {frame.x - kTick_px - 3.0, y + 0.36 * kTickLetters_px},
              tick_text(value, step_of(values)), kTickLetters_px, palette::kInk, 1.0);
  }
  draw_text(cr, {frame.x - kTick_px - 3.0, frame.y - 5.0}, axis.name, kTickLetters_px,
            palette::kInk, 1.0, true);
}

}  // namespace

std::vector<double> ticks(const Axis& axis, std::size_t most) {
  const double low = std::min(axis.begin, axis.end);
  const double high = std::max(axis.begin, axis.end);
  std::vector<double> values;
  if (!(high > low)) return values;
  const double step = round_step(high - low, most);
  const auto first = static_cast<std::int64_t>(std::ceil(low / step));
  const auto last = static_cast<std::int64_t>(std::floor(high / step));
  for (std::int64_t i = first; i <= last; ++i) values.push_back(static_cast<double>(i) * step);
  return values;
}

void draw_axes(cairo_t* cr, const Frame& frame, const Axis& across, const Axis& upward,
               bool has_grid) {
  draw_across(cr, frame, across, has_grid);
  draw_upward(cr, frame, upward, has_grid);
  cairo_rectangle(cr, frame.x, frame.y, frame.width, frame.height);
  stroke(cr, palette::kMuted, 1.0);
}

}  // namespace camway::draw
