// SPDX-License-Identifier: MIT
#include "daemon/correction/lattice_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <unordered_map>

namespace camway::correction {

namespace {

using geometry::Vec3;
using Cell = std::array<std::int32_t, 3>;

constexpr std::int32_t kFarthest = (1 << 20) - 1;  // so that a key takes 63 bits
constexpr double kComfort = 0.5;                   // of the ball: gap from which a way is not near
constexpr double kHorizon = 0.9;  // of a step: two gaps are more than the longest diagonal

class LatticeSearch {
 public:
  LatticeSearch(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                const LatticeOptions& options, const collision::Deadline& deadline)
      : space_(space),
        from_W_(from_W),
        to_W_(to_W),
        options_(options),
        deadline_(deadline),
        comfort_m_(kComfort * options.ball_radius_m),
        horizon_m_(std::max(kHorizon * options.spacing_m, comfort_m_)) {}

  LatticeResult run() {
    LatticeResult result = search();
    result.points = points_.size();
    return result;
  }

 private:
  LatticeResult search() {
    meet({0, 0, 0}, kNone, 0.0);
    LatticeResult result;
    while (!queue_.empty()) {
      const Waiting best = queue_.top();
      queue_.pop();
      if (points_[best.point].is_settled) continue;
      points_[best.point].is_settled = true;
      if (is_goal(best.point)) {
        result.way_W = way(best.point);
        return result;
      }
      if (points_.size() >= options_.max_points || is_late()) return result;
      expand(best.point);
    }
    result.exhausted = true;
    return result;
  }

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Point {
    Cell cell;
    std::uint32_t parent;
    double cost_m;
    double gap_m;
    bool is_settled = false;
  };
  struct Waiting {
    double estimate_m;
    std::uint32_t point;
    // The priority queue has the largest on top; among equals the one that was met first.
    bool operator<(const Waiting& other) const {
      return estimate_m != other.estimate_m ? estimate_m > other.estimate_m : point > other.point;
    }
  };

  // The clock is not asked at every point.
  bool is_late() { return (++settled_ % 64 == 0) && deadline_.passed(); }

  [[nodiscard]] double gap_m(const Vec3& point_W) const {
    return space_.ball_gap_m(point_W, options_.ball_radius_m, horizon_m_);
  }

  // What is told of a distance is too much to go by: the ball would step through thin walls.
  [[nodiscard]] double sure_gap_m(double gap_m) const {
    if (gap_m >= horizon_m_) return horizon_m_;  // nothing was met
    const double keep_m = options_.ball_radius_m + space_.detect().clearance_m;
    return FreeSpace::kBallShare * (gap_m + keep_m) - keep_m;
  }

  [[nodiscard]] Vec3 place_W(const Cell& cell) const {
    return from_W_ + options_.spacing_m * Vec3(cell[0], cell[1], cell[2]);
  }

  static std::uint64_t key(const Cell& cell) {
    std::uint64_t key = 0;
    for (const std::int32_t c : cell) key = (key << 21) | static_cast<std::uint64_t>(c + kFarthest);
    return key;
  }

  // The point of `cell`, asked for its gap if it is new.
  std::uint32_t point_at(const Cell& cell) {
    const auto [entry, is_new] =
        known_.try_emplace(key(cell), static_cast<std::uint32_t>(points_.size()));
    if (is_new) {
      points_.push_back(
          {cell, kNone, std::numeric_limits<double>::infinity(), gap_m(place_W(cell))});
    }
    return entry->second;
  }

  void meet(const Cell& cell, std::uint32_t parent, double cost_m) {
    Point& point = points_[point_at(cell)];
    point.parent = parent;
    point.cost_m = cost_m;
    const auto index = static_cast<std::uint32_t>(&point - points_.data());
    queue_.push({cost_m + (place_W(cell) - to_W_).norm(), index});
  }

  void expand(std::uint32_t index) {
    for (int code = 0; code < 27; ++code) {
      const Cell step = {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
      const Cell at = points_[index].cell;
      const Cell next = {at[0] + step[0], at[1] + step[1], at[2] + step[2]};
      if (code == 13 ||
          std::ranges::any_of(next, [](std::int32_t c) { return std::abs(c) >= kFarthest; })) {
        continue;
      }
      const std::uint32_t neighbour = point_at(next);
      const Point& from = points_[index];
      const Point& to = points_[neighbour];
      if (to.is_settled || !(to.gap_m > 0.0)) continue;
      const double length_m =
          options_.spacing_m * std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
      const double near = std::clamp(1.0 - std::min(from.gap_m, to.gap_m) / comfort_m_, 0.0, 1.0);
      const double cost_m = from.cost_m + length_m * (1.0 + near);
      if (!(cost_m < to.cost_m)) continue;
      if (!step_is_free(place_W(at), from.gap_m, place_W(next), to.gap_m)) continue;
      meet(next, index, cost_m);
    }
  }

  [[nodiscard]] bool step_is_free(const Vec3& a_W, double gap_a_m, const Vec3& b_W,
                                  double gap_b_m) const {
    if ((a_W - b_W).norm() <= sure_gap_m(gap_a_m) + sure_gap_m(gap_b_m)) return true;
    return space_.ball_passes(a_W, b_W, options_.ball_radius_m);
  }

  [[nodiscard]] bool is_goal(std::uint32_t index) const {
    const Point& point = points_[index];
    const Vec3 place = place_W(point.cell);
    const double reach_m = 1.8 * options_.spacing_m;  // more than the diagonal of a cell
    return (place - to_W_).norm() <= reach_m &&
           step_is_free(place, point.gap_m, to_W_, gap_m(to_W_));
  }

  [[nodiscard]] std::vector<Vec3> way(std::uint32_t last) const {
    std::vector<Vec3> way_W = {to_W_};
    for (std::uint32_t i = last; i != kNone; i = points_[i].parent) {
      way_W.push_back(place_W(points_[i].cell));
    }
    std::ranges::reverse(way_W);
    return way_W;
  }

  const FreeSpace& space_;
  const Vec3 from_W_;
  const Vec3 to_W_;
  const LatticeOptions& options_;
  const collision::Deadline& deadline_;
  const double comfort_m_;
  const double horizon_m_;
  std::vector<Point> points_;
  std::unordered_map<std::uint64_t, std::uint32_t> known_;  ///< looked up, never gone through
  std::priority_queue<Waiting> queue_;
  std::size_t settled_ = 0;
};

}  // namespace

LatticeResult lattice_way(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                          const LatticeOptions& options, const collision::Deadline& deadline) {
  return LatticeSearch(space, from_W, to_W, options, deadline).run();
}

}  // namespace camway::correction
