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

constexpr double kFarAway = 4.0;  // steps from the preferred way beyond which the cost is constant
constexpr double kStray = 0.15;   // relative extra cost of a step there
constexpr double kComfort = 0.5;  // share of the ball: gap from which a point is not near
constexpr double kHorizon = 0.9;  // share of a step: two gaps exceed the longest diagonal

class LatticeSearch {
 public:
  LatticeSearch(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                const LatticeOptions& options, const base::Deadline& deadline)
      : space_(space),
        from_W_(from_W),
        to_W_(to_W),
        options_(options),
        deadline_(deadline),
        comfort_m_(kComfort * options.ball_radius_m),
        horizon_m_(std::max(kHorizon * options.spacing_m, comfort_m_)) {
    for (std::size_t i = 1; i < options.about_W.size(); ++i) {
      legs_.emplace_back(options.about_W[i - 1], options.about_W[i]);
    }
  }

  LatticeResult run() {
    LatticeResult result = search();
    result.points = points_.size();
    return result;
  }

 private:
  LatticeResult search() {
    numbers_.around({0, 0, 0})[kNoStep] = 0;
    points_.push_back({key_of({0, 0, 0}), 0.0});
    queue_.push({rest_m(points_[0].key), 0});
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

  /// A leg of the preferred way.
  struct Leg {
    Leg(const Vec3& begin_W, const Vec3& end_W)
        : from_W(begin_W), along_W(end_W - begin_W), square_m2(along_W.squaredNorm()) {}

    [[nodiscard]] double squared_distance_m2(const Vec3& place_W) const {
      const Vec3 there_W = place_W - from_W;
      const double share = square_m2 > 0.0 ? along_W.dot(there_W) / square_m2 : 0.0;
      return (std::clamp(share, 0.0, 1.0) * along_W - there_W).squaredNorm();
    }

    Vec3 from_W;
    Vec3 along_W;
    double square_m2;
  };

  // Reads the clock at every 64th point only.
  bool is_late() { return (++settled_ % 64 == 0) && deadline_.passed(); }

  [[nodiscard]] double gap_m(const Vec3& point_W) const {
    return space_.ball_gap_m(point_W, options_.ball_radius_m, horizon_m_);
  }

  // Lower bound of the gap. `ball_gap_m` may overestimate, and the ball would step through thin
  // walls.
  [[nodiscard]] double sure_gap_m(double gap_m) const {
    if (gap_m >= horizon_m_) return horizon_m_;  // nothing was met
    const double keep_m = options_.ball_radius_m + space_.detect().clearance_m;
    return FreeSpace::kBallShare * (gap_m + keep_m) - keep_m;
  }

  [[nodiscard]] bool is_avoided(const Vec3& place) const {
    return std::ranges::any_of(options_.avoided, [&](const AvoidedBall& ball) {
      return (place - ball.center_W).norm() < ball.radius_m;
    });
  }

  [[nodiscard]] Vec3 place_W(CellKey key) const {
    const Cell cell = cell_of(key);
    return from_W_ + options_.spacing_m * Vec3(cell[0], cell[1], cell[2]);
  }

  /// `kLatticeGreed` times the length of the shortest way to the end on the lattice without
  /// obstacles: along diagonals of cells as far as they lead nearer, then along diagonals of faces,
  /// then along edges.
  [[nodiscard]] double rest_m(CellKey key) const {
    const Vec3 away = (place_W(key) - to_W_).cwiseAbs();
    const double less = std::min(away[0], away[1]);
    const double more = std::max(away[0], away[1]);
    const double middle = std::max(less, std::min(more, away[2]));
    const double length_m = std::max(more, away[2]) + (std::numbers::sqrt2 - 1.0) * middle +
                            (std::numbers::sqrt3 - std::numbers::sqrt2) * std::min(less, away[2]);
    return kLatticeGreed * length_m;
  }

  void claim(std::uint32_t index, double cost_m) {
    Point& point = points_[index];
    if (!(cost_m < point.claim_m)) return;
    point.claim_m = cost_m;
    queue_.push({cost_m + rest_m(point.key), index});
  }

  /// Lower bound of the cost of a step, by the gaps known so far.
  [[nodiscard]] double cost_of_step_m(std::size_t step, const Point& a, const Point& b) const {
    const double near = std::max(a.near, b.near);
    const double stray = 0.5 * (a.stray + b.stray);
    return options_.spacing_m * kLengths[step] * (1.0 + near + stray);
  }

  void ask(Point& point) const {
    const Vec3 place = place_W(point.key);
    point.gap_m = is_avoided(place) ? 0.0 : gap_m(place);
    point.near = std::max(0.0, 1.0 - point.gap_m / comfort_m_);
    if (legs_.empty()) return;
    const double far_m = kFarAway * options_.spacing_m;
    double away_m2 = far_m * far_m;
    for (const Leg& leg : legs_) away_m2 = std::min(away_m2, leg.squared_distance_m2(place));
    point.stray = kStray * std::sqrt(away_m2) / far_m;
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
    const double estimate_m = point.claim_m + rest_m(point.key);
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
      if (step_is_free(place_W(from.key), from.gap_m, place_W(point.key), point.gap_m)) {
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

  [[nodiscard]] bool step_is_free(const Vec3& a_W, double gap_a_m, const Vec3& b_W,
                                  double gap_b_m) const {
    if ((a_W - b_W).norm() <= sure_gap_m(gap_a_m) + sure_gap_m(gap_b_m)) return true;
    return space_.ball_passes(a_W, b_W, options_.ball_radius_m);
  }

  [[nodiscard]] bool is_goal(std::uint32_t index) const {
    const Point& point = points_[index];
    const Vec3 place = place_W(point.key);
    const double reach_m = 1.8 * options_.spacing_m;  // more than the diagonal of a cell
    return (place - to_W_).norm() <= reach_m &&
           step_is_free(place, point.gap_m, to_W_, gap_m(to_W_));
  }

  [[nodiscard]] std::vector<Vec3> way(std::uint32_t last) const {
    std::vector<Vec3> way_W = {to_W_};
    for (std::uint32_t i = last; i != CellNumbers::kNone; i = points_[i].parent) {
      way_W.push_back(place_W(points_[i].key));
    }
    std::ranges::reverse(way_W);
    return way_W;
  }

  const FreeSpace& space_;
  const Vec3 from_W_;
  const Vec3 to_W_;
  const LatticeOptions& options_;
  const base::Deadline& deadline_;
  const double comfort_m_;
  const double horizon_m_;
  std::vector<Leg> legs_;
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
