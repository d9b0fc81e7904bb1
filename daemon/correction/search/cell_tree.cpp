// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_tree.h"

#include <algorithm>
#include <numbers>

namespace camway::correction {

namespace {

using geometry::Vec3;

constexpr int kFinestLevel = 30;                             // places are numbers of 32 bits
constexpr double kHalfDiagonal = 0.5 * std::numbers::sqrt3;  // of a cell, in sides
// Sides of a cell, from its middle, of a wall that is bare. Chosen by measurement; it does not
// change what is free.
constexpr double kRoomInFront = 2.5;

}  // namespace

CellTree::CellTree(const FreeSpace& space, const CellOptions& options, const geometry::Box& around)
    : space_(space), options_(options) {
  side_m_ = around.sizes().maxCoeff();
  low_W_ = around.center().array() - 0.5 * side_m_;
  cells_.push_back({});
  classify(cells_[0]);
}

Vec3 CellTree::center_W(const OctreeCell& cell) const {
  const Vec3 at(static_cast<double>(cell.at[0]), static_cast<double>(cell.at[1]),
                static_cast<double>(cell.at[2]));
  return low_W_.array() + side_m(cell.level) * (at.array() + 0.5);
}

bool CellTree::may_divide(const OctreeCell& cell) const {
  return cell.level < kFinestLevel && side_m(cell.level + 1) >= options_.smallest_m;
}

std::optional<ClosedCorner> CellTree::corner_at(const OctreeCell& cell,
                                                const OctreeCell& beside) const {
  if (options_.body_gap_m) return std::nullopt;
  const double keep_m = options_.ball_radius_m + space_.query().required_clearance_m();
  const double reach_m = kRoomInFront * side_m(cell.level) + keep_m;
  const Vec3 center_W = this->center_W(cell);
  const geometry::Box box(center_W.array() - reach_m, center_W.array() + reach_m);
  const Vec3 from_W = this->center_W(beside).cwiseMax(box.min()).cwiseMin(box.max());
  return closed_corner(space_.obstacles(), box, from_W, keep_m);
}

double CellTree::gap_m(const OctreeCell& cell, double horizon_m) const {
  return space_.ball_gap_m(center_W(cell), options_.ball_radius_m, horizon_m);
}

std::uint32_t CellTree::divide(std::uint32_t index) {
  const auto first = static_cast<std::uint32_t>(cells_.size());
  cells_[index].children = first;
  const OctreeCell parent = cells_[index];
  for (std::int32_t i = 0; i < 8; ++i) {
    OctreeCell child;
    child.level = static_cast<std::int8_t>(parent.level + 1);
    child.at = {2 * parent.at[0] + (i & 1), 2 * parent.at[1] + (i >> 1 & 1),
                2 * parent.at[2] + (i >> 2)};
    classify(child);
    cells_.push_back(child);
  }
  return first;
}

std::optional<std::uint32_t> CellTree::free_cell_at(const Vec3& point_W) {
  std::uint32_t index = 0;
  while (true) {
    if (!cells_[index].is_divided()) {
      if (cells_[index].state == CellState::kFree) return index;
      if (cells_[index].state == CellState::kBlocked || !may_divide(cells_[index]))
        return std::nullopt;
      divide(index);
    }
    const Vec3 middle_W = center_W(cells_[index]);
    const std::uint32_t child = (point_W[0] >= middle_W[0] ? 1U : 0U) +
                                (point_W[1] >= middle_W[1] ? 2U : 0U) +
                                (point_W[2] >= middle_W[2] ? 4U : 0U);
    index = cells_[index].children + child;
  }
}

std::uint32_t CellTree::cell_at(const CellPlace& at, int level) const {
  std::uint32_t index = 0;
  for (int above = level - 1; above >= 0 && cells_[index].is_divided(); --above) {
    const std::int32_t child =
        (at[0] >> above & 1) | (at[1] >> above & 1) << 1 | (at[2] >> above & 1) << 2;
    index = cells_[index].children + static_cast<std::uint32_t>(child);
  }
  return index;
}

void CellTree::classify(OctreeCell& cell) const {
  const double reach_m = kHalfDiagonal * side_m(cell.level);
  if (options_.body_gap_m) {
    const double gap_m = options_.body_gap_m(center_W(cell), std::max(reach_m, options_.comfort_m));
    cell.gap_m = static_cast<float>(gap_m);
    if (gap_m >= reach_m) cell.state = CellState::kFree;
    return;
  }
  const double keep_m = options_.ball_radius_m + space_.query().required_clearance_m();
  // As far as it takes to prove the cell free, and to tell how much room there is.
  const double horizon_m = (keep_m + std::max(reach_m, options_.comfort_m)) / FreeSpace::kBallShare;
  const double distance_m =
      keep_m + space_.ball_gap_m(center_W(cell), options_.ball_radius_m, horizon_m - keep_m);
  const double sure_m = FreeSpace::kBallShare * distance_m;
  cell.gap_m = static_cast<float>(sure_m - keep_m);
  if (sure_m >= keep_m + reach_m) {
    cell.state = CellState::kFree;
  } else if (distance_m + reach_m <= keep_m) {
    cell.state = CellState::kBlocked;
  }
}

}  // namespace camway::correction
