// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/drawing/floor_plan.h"
#include "tools/drawing/marks.h"

namespace camway::draw {

/// A sample and its meaning.
struct LegendEntry {
  std::function<void(cairo_t*, const PlanPoint&)> draw_sample;  ///< about a point, 44 pixels wide
  std::string text;
};

/// Returns the samples of what a plan shows.
std::vector<LegendEntry> legend_of(const FloorPlan& plan, bool has_several_storeys);

/// Returns the samples of what the section of a scene shows.
std::vector<LegendEntry> section_legend();

/// Returns the height that the legend takes.
double legend_height_px(std::size_t entries);

/// Draws the entries in columns in a strip that begins at `corner`.
void draw_legend(cairo_t* cr, const PlanPoint& corner, double width_px,
                 const std::vector<LegendEntry>& entries);

}  // namespace camway::draw
