// SPDX-License-Identifier: MIT
#include "tools/drawing/panel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace camway::draw {
namespace {

constexpr double kHeadLetters_px = 20.0;
constexpr double kLine_px = 17.0;

std::vector<std::string> lines_of_head(const std::string& subtitle) {
  return broken_into_lines(subtitle, kLetters_px, kPictureWidth_px - 2 * kRim_px);
}

}  // namespace

PanelGrid arrange_panels(std::size_t count, const PlanBox& world, double top_px) {
  constexpr double kWide = 1.5;  // panels that are wider for their height stand below each other
  constexpr double kLeast_px = 220.0;
  constexpr double kMost_px = 640.0;
  const double aspect = world.sizes().x() / world.sizes().y();
  const std::size_t columns = count > 1 && aspect < kWide ? 2 : 1;
  const double column_px =
      (kPictureWidth_px - 2 * kRim_px - static_cast<double>(columns - 1) * kBlockGap_px) /
      static_cast<double>(columns);
  const double width = column_px - kAxisLeft_px;
  const double height = std::clamp(width / aspect, kLeast_px, kMost_px);
  const double row_px = kNameRoom_px + height + kAxisBelow_px + kBlockGap_px;
  PanelGrid grid{{}, top_px};
  for (std::size_t i = 0; i < count; ++i) {
    const double x = kRim_px + static_cast<double>(i % columns) * (column_px + kBlockGap_px);
    const double y = top_px + static_cast<double>(i / columns) * row_px;
    grid.views.push_back(fitted({x + kAxisLeft_px, y + kNameRoom_px, width, height}, world));
    grid.below_px = y + row_px;
  }
  return grid;
}

double head_height_px(const std::string& subtitle) {
  return 52.0 + kLine_px * static_cast<double>(lines_of_head(subtitle).size());
}

double draw_head(cairo_t* cr, const std::string& title, const std::string& subtitle) {
  draw_text(cr, {kRim_px, 32.0}, title, kHeadLetters_px, palette::kInk, 0.0, true);
  double y = 54.0;
  for (const std::string& line : lines_of_head(subtitle)) {
    draw_text(cr, {kRim_px, y}, line, kLetters_px, palette::kInk);
    y += kLine_px;
  }
  return head_height_px(subtitle);
}

std::string section_name(const FloorSection& section, SceneUp up, bool is_one) {
  const std::string cut = fmt::format("cut at {} = {:.2f} m", height_name(up), section.height_m);
  return is_one ? cut
                : fmt::format("storey at {} = {:.2f} m, {}", height_name(up), section.floor_m, cut);
}

}  // namespace camway::draw
