// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/drawing/height_strip.h"
#include "tools/drawing/legend.h"
#include "tools/drawing/panel_grid.h"
#include "tools/drawing/picture_file.h"
#include "tools/drawing/storey_panels.h"

namespace camway::draw {
namespace {

constexpr std::size_t kMostDetails = 3;
constexpr double kLeastEnlargement = 1.6;  // below it a detail shows nothing new
constexpr double kDetailHeight_px = 250.0;
constexpr double kStripHeight_px = 150.0;

/// A part of a panel that is shown enlarged.
struct Detail {
  std::size_t panel;
  PlanBox place;
  View view;
};

/// Everything of a picture and where it is.
struct Layout {
  std::vector<Panel> panels;
  PanelGrid grid;
  std::vector<Detail> details;
  Frame strip;
  std::vector<LegendEntry> legend;
  double legend_y_px;
  std::string subtitle;
  PictureSize size;
};

/// Adds the places of the collisions of a panel; those that are near each other are one.
void add_places(const FloorPlan& plan, const Panel& panel, std::size_t index,
                std::vector<Detail>& details) {
  constexpr double kAround_m = 0.7;
  for (const PanelCollision& collision : panel.collisions) {
    PlanBox box;
    for (const PathSample& s : collision.path) {
      const PlanPoint p = to_plan(s.pose.position, plan.up);
      box.extend(PlanPoint(p.array() - kAround_m));
      box.extend(PlanPoint(p.array() + kAround_m));
    }
    const auto near = std::find_if(details.begin(), details.end(), [&](const Detail& other) {
      return other.panel == index && other.place.intersects(box) &&
             other.place.merged(box).sizes().maxCoeff() < 6.0 * kAround_m;
    });
    if (near != details.end()) {
      near->place.extend(box);
    } else if (!box.isEmpty()) {
      details.push_back({index, box, {}});
    }
  }
}

/// Lays out the details in a row below `top_px`. Returns where the next thing may begin.
double lay_out_details(const FloorPlan& plan, double top_px, Layout& layout) {
  std::vector<Detail>& details = layout.details;
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    add_places(plan, layout.panels[i], i, details);
  }
  if (details.size() > kMostDetails) details.resize(kMostDetails);
  const auto place_all = [&] {
    const auto count = static_cast<double>(std::max<std::size_t>(details.size(), 2));
    const double width = (kPictureWidth_px - 2 * kRim_px - (count - 1) * kBlockGap_px) / count;
    for (std::size_t i = 0; i < details.size(); ++i) {
      const double x = kRim_px + static_cast<double>(i) * (width + kBlockGap_px);
      details[i].view =
          fitted({x, top_px + kNameRoom_px, width, kDetailHeight_px}, details[i].place);
    }
  };
  place_all();
  const double least = kLeastEnlargement * layout.grid.views.front().px_per_m;
  std::erase_if(details, [&](const Detail& detail) { return detail.view.px_per_m < least; });
  place_all();
  return details.empty() ? top_px : top_px + kNameRoom_px + kDetailHeight_px + kBlockGap_px;
}

/// Returns the subtitle, with the height of all keyframes if they have one.
std::string whole_subtitle(const FloorPlan& plan) {
  const auto given = std::ranges::find_if(plan.keyframes, [](const motion::Keyframe& keyframe) {
    return keyframe.origin != motion::KeyframeOrigin::kInserted;
  });
  if (given == plan.keyframes.end() || !are_level(plan.keyframes, plan.up)) return plan.subtitle;
  const std::string level = fmt::format("given keyframes at {} = {:.2f} m", height_name(plan.up),
                                        height_of(given->pose.position, plan.up));
  return plan.subtitle.empty() ? level : plan.subtitle + "; " + level;
}

Layout lay_out(const FloorPlan& plan) {
  Layout layout{storey_panels(plan), {}, {}, {}, {}, 0.0, whole_subtitle(plan), {}};
  layout.grid =
      arrange_panels(layout.panels.size(), world_shown(plan), head_height_px(layout.subtitle));
  double y = lay_out_details(plan, layout.grid.below_px, layout);
  if (!plan.before.empty() || !plan.after.empty()) {
    layout.strip = {kRim_px + kAxisLeft_px, y + kNameRoom_px,
                    kPictureWidth_px - 2 * kRim_px - kAxisLeft_px, kStripHeight_px};
    y += kNameRoom_px + kStripHeight_px + kAxisBelow_px + kBlockGap_px;
  }
  layout.legend = legend_of(plan, layout.panels.size() > 1);
  layout.legend_y_px = y;
  layout.size = {kPictureWidth_px, std::ceil(y + legend_height_px(layout.legend.size()) + kRim_px)};
  return layout;
}

std::string detail_name(std::size_t index) { return {static_cast<char>('A' + index)}; }

/// Returns the rectangle in a panel of what a detail shows.
PlanBox outline_of(const View& panel, const View& detail) {
  const PlanPoint half = PlanPoint(detail.frame.width, detail.frame.height) / (2 * detail.px_per_m);
  const PlanPoint begin(panel.frame.x, panel.frame.y);
  const PlanPoint end = begin + PlanPoint(panel.frame.width, panel.frame.height);
  return {panel.to_px(detail.center - half).cwiseMax(begin),
          panel.to_px(detail.center + half).cwiseMin(end)};
}

/// Returns the boxes of the names of the details of a panel, at the upper left of their outlines.
std::vector<PlanBox> name_boxes(const Layout& layout, std::size_t panel) {
  std::vector<PlanBox> boxes;
  for (const Detail& detail : layout.details) {
    if (detail.panel != panel) continue;
    const PlanPoint corner = outline_of(layout.grid.views[panel], detail.view).min();
    boxes.emplace_back(corner, corner + PlanPoint(18.0, 18.0));
  }
  return boxes;
}

/// Draws a dashed rectangle in a panel about what a detail shows.
void outline_detail(cairo_t* cr, const View& panel, const View& detail, const std::string& name) {
  const PlanPoint low = outline_of(panel, detail).min();
  const PlanPoint high = outline_of(panel, detail).max();
  cairo_rectangle(cr, low.x(), low.y(), high.x() - low.x(), high.y() - low.y());
  stroke_dashed(cr, palette::kInk, 1.1, 4.0);
  draw_text(cr, {low.x() + 4, low.y() + 15}, name, kLetters_px + 1, palette::kInk, 0.0, true);
}

void draw_panels(cairo_t* cr, const FloorPlan& plan, const Layout& layout) {
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const View& view = layout.grid.views[i];
    draw_view(cr, view, plan, layout.panels[i], name_boxes(layout, i));
    draw_plan_axes(cr, view, plan.up, false);
    draw_text(cr, {view.frame.x, view.frame.y - 7.0},
              section_name(layout.panels[i].section, plan.up, layout.panels.size() == 1),
              kLetters_px, palette::kInk, 0.0, true);
  }
  const Frame& first = layout.grid.views.front().frame;
  draw_scale_bar(cr, {first.x + first.width, first.y - 8.0}, layout.grid.views.front().px_per_m);
}

void draw_details(cairo_t* cr, const FloorPlan& plan, const Layout& layout) {
  for (std::size_t i = 0; i < layout.details.size(); ++i) {
    const Detail& detail = layout.details[i];
    const View& panel = layout.grid.views[detail.panel];
    draw_view(cr, detail.view, plan, layout.panels[detail.panel]);
    draw_text(cr, {detail.view.frame.x, detail.view.frame.y - 7.0},
              fmt::format("{}, {:.1f} times larger", detail_name(i),
                          detail.view.px_per_m / panel.px_per_m),
              kLetters_px, palette::kInk, 0.0, true);
    outline_detail(cr, panel, detail.view, detail_name(i));
  }
}

void draw_all(cairo_t* cr, const FloorPlan& plan, const Layout& layout) {
  draw_head(cr, plan.title, layout.subtitle);
  draw_panels(cr, plan, layout);
  draw_details(cr, plan, layout);
  if (layout.strip.width > 0.0) {
    draw_text(cr, {layout.strip.x, layout.strip.y - 7.0}, "height over time", kLetters_px,
              palette::kInk, 0.0, true);
    std::vector<double> floors_m;
    for (const Panel& panel : layout.panels) floors_m.push_back(panel.section.floor_m);
    draw_height_strip(cr, layout.strip, plan, floors_m);
  }
  draw_legend(cr, {kRim_px, layout.legend_y_px}, kPictureWidth_px - 2 * kRim_px, layout.legend);
}

}  // namespace

SampledPath sample(const motion::Path& path, std::size_t count) {
  SampledPath samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(count - 1);
    const double time_s = path.begin_s() + s * (path.end_s() - path.begin_s());
    samples.push_back({time_s, path.pose(time_s)});
  }
  return samples;
}

double cut_height_m(const scene::Mesh& mesh, SceneUp up,
                    const std::vector<motion::Keyframe>& keyframes) {
  constexpr double kUsual_m = 1.5;      // above the floor: cuts doors and windows open
  constexpr double kTolerated_m = 0.7;  // up to here, being in the middle counts more
  constexpr std::size_t kMostTried = 9;
  std::vector<double> heights;
  for (const motion::Keyframe& k : keyframes) heights.push_back(height_of(k.pose.position, up));
  if (heights.empty()) return 0.0;
  std::sort(heights.begin(), heights.end());
  const double middle = heights[(heights.size() - 1) / 2];
  double best = middle;
  double best_penalty = HUGE_VAL;
  const std::size_t tried = std::min(heights.size(), kMostTried);
  for (std::size_t i = 0; i <= tried; ++i) {
    const double h =
        i == 0 ? middle
               : heights[(i - 1) * (heights.size() - 1) / std::max<std::size_t>(tried - 1, 1)];
    const double above_floor = h - find_floor_m(mesh, up, h);
    const double penalty = std::max(0.0, std::abs(above_floor - kUsual_m) - kTolerated_m);
    if (penalty < best_penalty) {
      best = h;
      best_penalty = penalty;
    }
  }
  return best;
}

std::string draw_floor_plan(const FloorPlan& plan, const PictureFiles& files) {
  const Layout layout = lay_out(plan);
  return write_pictures(files, layout.size, [&](cairo_t* cr) { draw_all(cr, plan, layout); });
}

std::string floor_plan_svg(const FloorPlan& plan) {
  const Layout layout = lay_out(plan);
  return svg_picture(layout.size, [&](cairo_t* cr) { draw_all(cr, plan, layout); });
}

}  // namespace camway::draw
