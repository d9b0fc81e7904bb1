// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_regions.h"

#include <algorithm>
#include <cmath>

namespace camway::correction {

namespace {

using geometry::Vec3;

// An end reaches much less than the other if its volume is below this share of the other's, with as
// many cells. Chosen by measurement.
constexpr double kMuchLess = 0.125;

}  // namespace

OfEnds<CellRegion> regions_reached(const CellTree& tree) {
  OfEnds<CellRegion> regions;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const OctreeCell& cell = tree[i];
    if (cell.is_divided() || cell.reached.empty()) continue;
    const double half_m = 0.5 * tree.side_m(cell.level);
    const Vec3 center_W = tree.center_W(cell);
    geometry::Box box(center_W.array() - half_m, center_W.array() + half_m);
    double wall_m = 0.0;
    // The walls are somewhere in the cells beside it that are not free.
    tree.for_each_neighbour(i, [&](std::uint32_t next) {
      if (tree[next].state != CellState::kMixed) return;
      box.extend(tree.center_W(tree[next]));
      wall_m = std::max(wall_m, 0.5 * tree.side_m(tree[next].level));
    });
    for (std::size_t end = 0; end < kCellEnds; ++end) {
      if (!cell.reached.has(end)) continue;
      regions[end].box_W.extend(box);
      regions[end].unsure_m = std::max(regions[end].unsure_m, wall_m);
      regions[end].volume_m3 += std::pow(2.0 * half_m, 3);
    }
  }
  return regions;
}

OfEnds<bool> ends_in_narrow_places(const CellTree& tree, double narrow_m) {
  OfEnds<bool> is_narrow{};
  for (std::size_t end = 0; end < kCellEnds; ++end) {
    bool has_room = !(narrow_m > 0.0);
    for (std::uint32_t i = 0; i < tree.size() && !has_room; ++i) {
      const OctreeCell& cell = tree[i];
      if (cell.is_divided() || !cell.reached.has(end)) continue;
      has_room = tree.gap_m(cell, narrow_m) >= narrow_m;
    }
    is_narrow[end] = !has_room;
  }
  return is_narrow;
}

Pocket complete_pocket(const CellTree& tree, std::size_t end, const OfEnds<bool>& is_narrow) {
  const CellRegion found = regions_reached(tree)[end];
  return {end == 1, found.box_W, found.unsure_m, true, is_narrow[end]};
}

std::optional<Pocket> pocket_so_far(const CellTree& tree, const OfEnds<bool>& is_narrow,
                                    bool has_way) {
  const OfEnds<CellRegion> found = regions_reached(tree);
  const bool is_at_end =
      is_narrow[0] != is_narrow[1] ? is_narrow[1] : found[1].volume_m3 < found[0].volume_m3;
  const std::size_t end = is_at_end ? 1 : 0;
  const bool is_less = found[end].volume_m3 < kMuchLess * found[1 - end].volume_m3;
  const bool is_known = found[end].volume_m3 > 0.0 && (is_narrow[end] || (is_less && !has_way));
  if (!is_known) return std::nullopt;
  return Pocket{is_at_end, found[end].box_W, found[end].unsure_m, false, is_narrow[end]};
}

}  // namespace camway::correction
