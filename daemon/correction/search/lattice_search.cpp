// SPDX-License-Identifier: MIT
#include "daemon/correction/search/lattice_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "daemon/correction/search/cell_numbers.h"
#include "daemon/correction/search/lattice.h"

namespace camway::correction {

namespace {

using geometry::Vec3;

/// Lengths of the steps to neighbours. [Units: spacing of the lattice]
constexpr std::array<double, kCellSteps> kLengths = [] {
  constexpr std::array<double, 4> kRoots = {0.0, 1.0, std::numbers::sqrt2, std::numbers::sqrt3};
  std::array<double, kCellSteps> lengths{};
  for (int i = 0; i < static_cast<int>(kCellSteps); ++i) {
    const int axes = (i % 3 != 1 ? 1 : 0) + (i / 3 % 3 != 1 ? 1 : 0) + (i / 9 != 1 ? 1 : 0);
    lengths[static_cast<std::size_t>(i)] = kRoots[static_cast<std::size_t>(axes)];
  }
  return lengths;
}();

class LatticeSearch {
 public:
  LatticeSearch(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                const LatticeOptions& options, const base::Deadline& deadline)
      : lattice_(space, from_W, to_W, options), options_(options), deadline_(deadline) {}

  LatticeResult run() {
    LatticeResult result = search();
    result.points = points_.size();
    return result;
  }

 private:
  LatticeResult search() {
    numbers_.around({0, 0, 0})[kNoStep] = 0;
    points_.push_back({key_of({0, 0, 0}), 0.0});
    queue_.push({lattice_.rest_m(points_[0].key), 0});
    LatticeResult result;
    while (!queue_.empty()) {
      const Waiting best = queue_.top();
      if (best.estimate_m > options_.max_cost_m) return result;
      queue_.pop();
      if (!settles(best)) continue;
      if (is_goal(best.point)) {
        result.way_W = way(best.point);
        result.cost_m = points_[best.point].claim_m;
        return result;
      }
      if (points_.size() >= options_.max_points || is_late()) return result;
      expand(best.point);
    }
    result.exhausted = true;
    return result;
  }

  static constexpr double kUnknown_m = std::numeric_limits<double>::infinity();

  struct Point {
    CellKey key;
    /// Cost of the way here; a lower bound until the point is settled.
    double claim_m = std::numeric_limits<double>::infinity();
    double gap_m = kUnknown_m;  ///< gap of the ball; unknown until the scene is queried
    double near = 0.0;          ///< relative extra cost of steps near the scene
    double stray = 0.0;         ///< relative extra cost of steps away from the preferred way
    std::uint32_t parent = CellNumbers::kNone;
    std::uint32_t settled_from = 0;  ///< a bit for each step that leads here from a settled point
    bool is_settled = false;

    [[nodiscard]] bool is_blocked() const { return gap_m <= 0.0; }
  };
  struct Waiting {
    double estimate_m;
    std::uint32_t point;
    // The queue pops the largest element: the least estimate, among equals the point visited first.
    bool operator<(const Waiting& other) const {
      return estimate_m != other.estimate_m ? estimate_m > other.estimate_m : point > other.point;
    }
  };

  static constexpr std::size_t kStepsPerDeadlineCheck = 64;  // a step settles a point

  bool is_late() { return (++settled_ % kStepsPerDeadlineCheck == 0) && deadline_.passed(); }

  void claim(std::uint32_t index, double cost_m) {
    Point& point = points_[index];
    if (!(cost_m < point.claim_m)) return;
    point.claim_m = cost_m;
    queue_.push({cost_m + lattice_.rest_m(point.key), index});
  }

  /// Lower bound of the cost of a step, by the gaps known so far.
  [[nodiscard]] double cost_of_step_m(std::size_t step, const Point& a, const Point& b) const {
    const double near = std::max(a.near, b.near);
    const double stray = 0.5 * (a.stray + b.stray);
    return options_.spacing_m * kLengths[step] * (1.0 + near + stray);
  }

  void ask(Point& point) const {
    const Lattice::Surroundings found = lattice_.about(lattice_.place_W(point.key));
    point.gap_m = found.gap_m;
    point.near = found.near;
    point.stray = found.stray;
  }

  void expand(std::uint32_t index) {
    const Point from = points_[index];
    const CellNumbers::Around around = numbers_.around(cell_of(from.key));
    for (std::size_t step = 0; step < kCellSteps; ++step) {
      if (step == kNoStep) continue;
      std::uint32_t& next = around[step];
      if (next == CellNumbers::kNone) {
        next = static_cast<std::uint32_t>(points_.size());
        points_.push_back({from.key + kKeySteps[step]});
      }
      Point& to = points_[next];
      if (to.is_settled || to.is_blocked()) continue;
      to.settled_from |= 1U << step;
      claim(next, from.claim_m + cost_of_step_m(step, from, to));
    }
  }

  /// Queries the scene about a point when it comes first in the queue; most visited points never
  /// do. Returns whether the point is settled at its claimed cost; otherwise it is queued again at
  /// its true cost, or waits for another neighbour.
  bool settles(const Waiting& best) {
    const std::uint32_t index = best.point;
    Point& point = points_[index];
    if (point.is_settled || point.is_blocked()) return false;
    if (point.gap_m == kUnknown_m) ask(point);
    if (point.is_blocked() && index != 0) return false;
    if (index != 0) find_parent(point);
    const double estimate_m = point.claim_m + lattice_.rest_m(point.key);
    if (!(estimate_m <= best.estimate_m)) {
      if (std::isfinite(estimate_m)) queue_.push({estimate_m, index});
      return false;
    }
    point.is_settled = true;
    return true;
  }

  /// Sets the settled neighbour with the cheapest free step to the point, and the cost.
  void find_parent(Point& point) {
    while (point.settled_from != 0) {
      const Entry best = cheapest_entry(point);
      const Point& from = points_[best.from];
      if (lattice_.step_is_free(lattice_.place_W(from.key), from.gap_m, lattice_.place_W(point.key),
                                point.gap_m)) {
        point.parent = best.from;
        point.claim_m = best.cost_m;
        return;
      }
      point.settled_from &= ~(1U << best.step);
    }
    point.claim_m = std::numeric_limits<double>::infinity();
  }

  struct Entry {
    double cost_m = std::numeric_limits<double>::infinity();
    std::uint32_t from = CellNumbers::kNone;
    std::size_t step = 0;
  };

  [[nodiscard]] Entry cheapest_entry(const Point& point) {
    Entry best;
    const CellNumbers::Around around = numbers_.around(cell_of(point.key));
    for (std::uint32_t steps = point.settled_from; steps != 0; steps &= steps - 1) {
      const auto step = static_cast<std::size_t>(std::countr_zero(steps));
      const std::uint32_t index = around[kCellSteps - 1 - step];
      const Point& from = points_[index];
      const double cost_m = from.claim_m + cost_of_step_m(step, from, point);
      if (cost_m < best.cost_m) best = {cost_m, index, step};
    }
    return best;
  }

  [[nodiscard]] bool is_goal(std::uint32_t index) const {
    const Point& point = points_[index];
    return lattice_.meets_end(lattice_.place_W(point.key), point.gap_m);
  }

  [[nodiscard]] std::vector<Vec3> way(std::uint32_t last) const {
    std::vector<Vec3> way_W = {lattice_.end_W()};
    for (std::uint32_t i = last; i != CellNumbers::kNone; i = points_[i].parent) {
      way_W.push_back(lattice_.place_W(points_[i].key));
    }
    std::ranges::reverse(way_W);
    return way_W;
  }

  const Lattice lattice_;
  const LatticeOptions& options_;
  const base::Deadline& deadline_;
  std::vector<Point> points_;
  CellNumbers numbers_;  ///< numbers of points
  std::priority_queue<Waiting> queue_;
  std::size_t settled_ = 0;
};

}  // namespace

LatticeResult lattice_way(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                          const LatticeOptions& options, const base::Deadline& deadline) {
  return LatticeSearch(space, from_W, to_W, options, deadline).run();
}

}  // namespace camway::correction
