// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "tools/drawing/floor_plan_view.h"

namespace camway::draw {

/// Width of pictures, and the empty rim inside. Pictures are as wide as a page of text.
inline constexpr double kPictureWidth_px = 1000.0;
inline constexpr double kRim_px = 18.0;
inline constexpr double kBlockGap_px = 14.0;
/// Room above a frame for its name. [Units: pixels]
inline constexpr double kNameRoom_px = 24.0;

/// Panels that all show the same part of the plan, for comparison.
struct PanelGrid {
  std::vector<View> views;
  double below_px;  ///< where the next thing may begin
};

/// Arranges `count` panels with axes below `top_px`: one beside the other where they are tall.
PanelGrid arrange_panels(std::size_t count, const PlanBox& world, double top_px);

/// Draws title and subtitle. Returns where the next thing may begin.
double draw_head(cairo_t* cr, const std::string& title, const std::string& subtitle);
/// Returns what `draw_head` returns, without drawing.
double head_height_px(const std::string& subtitle);

/// Returns the name of a storey: "storey at y = 3.00 m, cut at 4.60 m".
std::string section_name(const FloorSection& section, SceneUp up, bool is_one);

}  // namespace camway::draw
