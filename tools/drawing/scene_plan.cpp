// SPDX-License-Identifier: MIT
#include "tools/drawing/scene_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/drawing/legend.h"
#include "tools/drawing/panel_grid.h"
#include "tools/drawing/picture_file.h"
#include "tools/drawing/storeys.h"

namespace camway::draw {
namespace {

constexpr std::size_t kMostStoreys = 8;

Eigen::AlignedBox3d box_of(const scene::Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const geometry::Vec3& vertex : mesh.vertices) box.extend(vertex);
  if (box.isEmpty()) box.extend(geometry::Vec3::Zero());
  return box;
}

std::vector<FloorSection> sections_of(const ScenePlan& plan, const Eigen::AlignedBox3d& box) {
  std::vector<FloorSection> sections;
  for (const double floor_m : storeys_of(plan.mesh, plan.up)) {
    if (sections.size() == kMostStoreys) break;
    sections.push_back(cut_floor(plan.mesh, plan.up, floor_m + kEyes_m, floor_m));
  }
  if (sections.empty()) {
    const double low_m = height_of(box.min(), plan.up);
    const double high_m = height_of(box.max(), plan.up);
    sections.push_back(cut_floor(plan.mesh, plan.up, (low_m + high_m) / 2, low_m));
  }
  return sections;
}

std::string extent_of(const ScenePlan& plan, const Eigen::AlignedBox3d& box) {
  const bool is_y = plan.up == SceneUp::kY;
  std::string text = fmt::format(
      "x from {:.2f} to {:.2f}, y from {:.2f} to {:.2f}, z from {:.2f} to {:.2f} m; {} points up",
      box.min().x(), box.max().x(), box.min().y(), box.max().y(), box.min().z(), box.max().z(),
      is_y ? "y" : "z");
  return plan.remark.empty() ? text : text + ' ' + plan.remark;
}

PlanBox with_margin(const scene::Mesh& mesh, SceneUp up) {
  PlanBox world = bounds_on_paper(mesh, up);
  if (world.isEmpty()) world.extend(PlanPoint(0.0, 0.0));
  const double largest_m = world.sizes().maxCoeff();
  const double margin_m = largest_m > 0.0 ? 0.03 * largest_m : 1.0;
  return {PlanPoint(world.min().array() - margin_m), PlanPoint(world.max().array() + margin_m)};
}

}  // namespace

std::string draw_scene_plan(const ScenePlan& plan, const PictureFiles& files) {
  const Eigen::AlignedBox3d box = box_of(plan.mesh);
  const std::vector<FloorSection> sections = sections_of(plan, box);
  const std::string subtitle = extent_of(plan, box);
  const PanelGrid grid =
      arrange_panels(sections.size(), with_margin(plan.mesh, plan.up), head_height_px(subtitle));
  const std::vector<LegendEntry> legend = section_legend();
  const PictureSize size{kPictureWidth_px,
                         grid.below_px + legend_height_px(legend.size()) + kRim_px};
  return write_pictures(files, size, [&](cairo_t* cr) {
    draw_head(cr, plan.title, subtitle);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const View& view = grid.views[i];
      draw_section(cr, view, sections[i]);
      draw_plan_axes(cr, view, plan.up, true);
      draw_text(cr, {view.frame.x, view.frame.y - 7.0},
                section_name(sections[i], plan.up, sections.size() == 1), kLetters_px,
                palette::kInk, 0.0, true);
    }
    draw_legend(cr, {kRim_px, grid.below_px}, kPictureWidth_px - 2 * kRim_px, legend);
    draw_scale_bar(cr, {kPictureWidth_px - kRim_px, grid.below_px + 14.0},
                   grid.views.front().px_per_m);
  });
}

}  // namespace camway::draw
