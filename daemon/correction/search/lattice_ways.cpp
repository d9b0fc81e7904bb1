// SPDX-License-Identifier: MIT
#include "daemon/correction/search/lattice_ways.h"

#include <algorithm>
#include <array>

#include "daemon/correction/search/lattice_search.h"

namespace camway::correction {

namespace {

/// A lattice to be searched. Chosen by measurement.
struct Level {
  double spacing;  ///< relative to the coarse one
  std::size_t max_points;
  bool is_wide;  ///< reaches further than those before it, for ways that are long
};
constexpr std::array<Level, 6> kLevels = {{{1.0, 4000, false},
                                           {0.5, 8000, false},
                                           {2.0, 8000, true},
                                           {1.0, 60000, true},
                                           {0.25, 60000, false},
                                           {0.125, 120000, false}}};
constexpr int kRunsBeforeWider = 2;  // lattices in a row from which on wider ones are searched
constexpr std::size_t kFirstCostlyLevel = 2;
constexpr std::size_t kFinestLattice = kLevels.size() - 1;

class LatticeWays {
 public:
  LatticeWays(const FreeSpace& space, const BallMotion& ball,
              std::span<const geometry::Vec3> about_W, const base::Deadline& deadline)
      : space_(space), ball_(ball), about_W_(about_W), deadline_(deadline) {}

  /// Searches the two coarsest lattices, the second only if the points of the first did not run
  /// out.
  void search_coarse(const LatticeWayUse& use) {
    for (std::size_t i = 0; i < kFirstCostlyLevel; ++i) {
      const LatticeResult found = searched(kLevels[i], false);
      if (!found.way_W.empty() && use.use(found)) return;
      if (found.way_W.empty() && !found.exhausted) return;
    }
  }

  void search(std::size_t first_level, std::size_t last_level, const LatticeWayUse& use) {
    bool from_end = false;
    int times_run_out = 0;
    for (std::size_t i = first_level; i <= last_level && !deadline_.passed(); ++i) {
      const Level& level = kLevels[i];
      if (i == 1 && use.is_hopeless()) return;
      if (i == kFirstCostlyLevel && use.is_done()) return;
      if (level.is_wide && times_run_out < kRunsBeforeWider) continue;
      const LatticeResult found = searched(level, from_end);
      if (!found.way_W.empty() && use.use(found)) return;
      const bool ran_out = found.way_W.empty() && !found.exhausted;
      if (level.is_wide || from_end || !ran_out || ++times_run_out != kRunsBeforeWider) continue;
      // If less is reachable from the other end, this search finds a way or ends quickly.
      const LatticeResult back = searched(level, true);
      if (!back.way_W.empty() && use.use(back)) return;
      from_end = back.exhausted;
      if (from_end) times_run_out = 0;
    }
  }

  [[nodiscard]] std::size_t points() const { return points_; }

 private:
  LatticeResult searched(const Level& level, bool from_end) {
    const double coarse_m = std::max(ball_.radius_m, (ball_.to_W - ball_.from_W).norm() / 8.0);
    LatticeOptions options{ball_.radius_m, ball_.coarseness * level.spacing * coarse_m,
                           std::min(level.max_points, ball_.max_points)};
    // Preferring a polyline expands more nodes, and wide lattices search far from it anyway.
    if (!level.is_wide) options.about_W = about_W_;
    options.avoided = ball_.avoided;
    options.max_cost_m = ball_.max_cost_m;
    LatticeResult found = lattice_way(space_, from_end ? ball_.to_W : ball_.from_W,
                                      from_end ? ball_.from_W : ball_.to_W, options, deadline_);
    points_ += found.points;
    if (from_end) std::ranges::reverse(found.way_W);
    return found;
  }

  const FreeSpace& space_;
  const BallMotion& ball_;
  const std::span<const geometry::Vec3> about_W_;
  const base::Deadline& deadline_;
  std::size_t points_ = 0;
};

std::size_t last_level(Lattices lattices) {
  return lattices == Lattices::kFinest ? kFinestLattice : kFinestLattice - 1;
}

}  // namespace

std::size_t for_each_lattice_way(const FreeSpace& space, const BallMotion& ball, Lattices lattices,
                                 std::span<const geometry::Vec3> about_W, const LatticeWayUse& use,
                                 const base::Deadline& deadline) {
  LatticeWays ways(space, ball, about_W, deadline);
  if (lattices == Lattices::kCoarse) {
    ways.search_coarse(use);
  } else {
    ways.search(lattices == Lattices::kFinest ? kFinestLattice : 0, last_level(lattices), use);
  }
  return ways.points();
}

}  // namespace camway::correction
