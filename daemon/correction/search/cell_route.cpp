// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_route.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace camway::correction {

namespace {

using geometry::Vec3;

// Times its length that a way without room costs more. Chosen by measurement.
constexpr double kMostNear = 8.0;

struct RouteStep {
  double cost_m = std::numeric_limits<double>::infinity();
  std::uint32_t parent = kNoCell;
};

struct OpenRoute {
  double cost_m;
  std::uint32_t cell;
  // The priority queue has the cheapest on top; among equals the cell that was made first.
  bool operator<(const OpenRoute& other) const {
    return cost_m != other.cost_m ? cost_m > other.cost_m : cell > other.cell;
  }
};

double step_cost_m(const OctreeCell& a, const OctreeCell& b, const CellTree& tree,
                   double comfort_m) {
  const double gap_m = static_cast<double>(std::min(a.gap_m, b.gap_m));
  const double near = std::clamp(1.0 - gap_m / comfort_m, 0.0, 1.0);
  const double length_m = (tree.center_W(a) - tree.center_W(b)).norm();
  return length_m * (1.0 + kMostNear * near);
}

/// Dijkstra's algorithm, until the goal is reached.
std::vector<RouteStep> steps_to(const CellTree& tree, std::uint32_t start, std::uint32_t goal,
                                double comfort_m) {
  std::vector<RouteStep> steps(tree.size());
  std::priority_queue<OpenRoute> open;
  steps[start].cost_m = 0.0;
  open.push({0.0, start});
  while (!open.empty()) {
    const OpenRoute at = open.top();
    open.pop();
    if (at.cell == goal) break;
    if (at.cost_m > steps[at.cell].cost_m) continue;
    tree.for_each_neighbour(at.cell, [&](std::uint32_t next) {
      if (tree[next].reached.empty()) return;
      const double cost_m =
          steps[at.cell].cost_m + step_cost_m(tree[at.cell], tree[next], tree, comfort_m);
      if (!(cost_m < steps[next].cost_m)) return;
      steps[next] = {cost_m, at.cell};
      open.push({cost_m, next});
    });
  }
  return steps;
}

}  // namespace

std::vector<Vec3> cheapest_way(const CellTree& tree, std::uint32_t start, std::uint32_t goal,
                               double comfort_m) {
  const std::vector<RouteStep> steps = steps_to(tree, start, goal, comfort_m);
  std::vector<Vec3> way_W = {tree.center_W(tree[goal])};
  for (std::uint32_t cell = goal; cell != start; cell = steps[cell].parent) {
    way_W.push_back(tree.center_W(tree[steps[cell].parent]));
  }
  std::ranges::reverse(way_W);
  return way_W;
}

}  // namespace camway::correction
