// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>

#include "daemon/correction/search/closed_corner.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using Place = std::array<std::int32_t, 3>;

constexpr int kFinestLevel = 30;  // places are numbers of 32 bits
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kHalfDiagonal = 0.5 * std::numbers::sqrt3;  // of a cell, in sides
// Chosen by measurement; none changes what is free.
constexpr double kMostNear = 8.0;      // times its length that a way without room costs more
constexpr double kMarginAround = 4.0;  // balls around the scene: ways may lead there too
constexpr double kRoomInFront = 2.5;   // sides of a cell, from its middle, of a wall that is bare
constexpr std::size_t kLooksPerClock = 64;  // looks at a cell for each reading of the clock
// An end reaches much less than the other if its volume is below this share of the other's, with as
// many cells.
constexpr double kMuchLess = 0.125;

enum class State : std::uint8_t { kFree, kMixed, kBlocked };

constexpr std::array<std::uint8_t, 2> kEnds = {1, 2};  // bits: of the begin and of the end

struct OctreeCell {
  Place at{};                      ///< from the corner of the whole, in sides of the cell
  std::uint32_t children = kNone;  ///< the first of eight
  float gap_m = 0.0F;              ///< of the ball in the middle, for free cells
  std::int8_t level = 0;           ///< how often the whole was divided
  State state = State::kMixed;
  std::uint8_t reached = 0;  ///< from which ends
  std::uint8_t waiting = 0;  ///< for which ends
};

/// The whole, divided as far as somebody asked.
class CellTree {
 public:
  CellTree(const FreeSpace& space, const CellOptions& options, const geometry::Box& around)
      : space_(space), options_(options) {
    side_m_ = around.sizes().maxCoeff();
    low_W_ = around.center().array() - 0.5 * side_m_;
    cells_.push_back({});
    classify(cells_[0]);
  }

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  OctreeCell& operator[](std::uint32_t index) { return cells_[index]; }
  const OctreeCell& operator[](std::uint32_t index) const { return cells_[index]; }

  [[nodiscard]] double side_m(int level) const { return std::ldexp(side_m_, -level); }
  [[nodiscard]] Vec3 center_W(const OctreeCell& cell) const {
    const Vec3 at(static_cast<double>(cell.at[0]), static_cast<double>(cell.at[1]),
                  static_cast<double>(cell.at[2]));
    return low_W_.array() + side_m(cell.level) * (at.array() + 0.5);
  }
  [[nodiscard]] bool may_divide(const OctreeCell& cell) const {
    return cell.level < kFinestLevel && side_m(cell.level + 1) >= options_.smallest_m;
  }

  /// Returns the closed corner that a cell stands in, as seen from the middle of the cell beside
  /// it, with room for further cells of that size in front. Returns nothing if there is none.
  [[nodiscard]] std::optional<ClosedCorner> corner_at(const OctreeCell& cell,
                                                      const OctreeCell& beside) const {
    const double keep_m = options_.ball_radius_m + space_.detect().clearance_m;
    const double reach_m = kRoomInFront * side_m(cell.level) + keep_m;
    const Vec3 center_W = this->center_W(cell);
    const geometry::Box box(center_W.array() - reach_m, center_W.array() + reach_m);
    const Vec3 from_W = this->center_W(beside).cwiseMax(box.min()).cwiseMin(box.max());
    return closed_corner(space_.obstacles(), box, from_W, keep_m);
  }

  /// Gap of the ball in the middle of a cell, as far as it is less than `horizon_m`.
  [[nodiscard]] double gap_m(const OctreeCell& cell, double horizon_m) const {
    return space_.ball_gap_m(center_W(cell), options_.ball_radius_m, horizon_m);
  }

  /// The first of the new cells.
  std::uint32_t divide(std::uint32_t index) {
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

  /// The free cell that holds a point; divides until there is one.
  std::optional<std::uint32_t> free_cell_at(const Vec3& point_W) {
    std::uint32_t index = 0;
    while (true) {
      if (cells_[index].children == kNone) {
        if (cells_[index].state == State::kFree) return index;
        if (cells_[index].state == State::kBlocked || !may_divide(cells_[index]))
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

  /// Calls `visit(neighbour)` for each undivided cell on the other side of a face.
  template <class Visit>
  void for_each_neighbour(std::uint32_t index, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int32_t step : {-1, 1}) {
        Place at = cells_[index].at;
        at[axis] += step;
        if (at[axis] < 0 || at[axis] >> cells_[index].level != 0) continue;
        visit_face(cell_at(at, cells_[index].level), axis, step, visit);
      }
    }
  }

 private:
  /// The cell there, or an undivided one that holds it.
  [[nodiscard]] std::uint32_t cell_at(const Place& at, int level) const {
    std::uint32_t index = 0;
    for (int above = level - 1; above >= 0 && cells_[index].children != kNone; --above) {
      const std::int32_t child =
          (at[0] >> above & 1) | (at[1] >> above & 1) << 1 | (at[2] >> above & 1) << 2;
      index = cells_[index].children + static_cast<std::uint32_t>(child);
    }
    return index;
  }

  /// Visits the undivided cells within a cell at the face through which a step enters it.
  template <class Visit>
  void visit_face(std::uint32_t index, std::size_t axis, std::int32_t step,
                  const Visit& visit) const {
    if (cells_[index].children == kNone) {
      visit(index);
      return;
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
      if ((i >> axis & 1U) == (step > 0 ? 0U : 1U))
        visit_face(cells_[index].children + i, axis, step, visit);
    }
  }

  void classify(OctreeCell& cell) const {
    const double reach_m = kHalfDiagonal * side_m(cell.level);
    const double keep_m = options_.ball_radius_m + space_.detect().clearance_m;
    // As far as it takes to prove the cell free, and to tell how much room there is.
    const double horizon_m =
        (keep_m + std::max(reach_m, options_.comfort_m)) / FreeSpace::kBallShare;
    const double distance_m =
        keep_m + space_.ball_gap_m(center_W(cell), options_.ball_radius_m, horizon_m - keep_m);
    const double sure_m = FreeSpace::kBallShare * distance_m;
    cell.gap_m = static_cast<float>(sure_m - keep_m);
    if (sure_m >= keep_m + reach_m) {
      cell.state = State::kFree;
    } else if (distance_m + reach_m <= keep_m) {
      cell.state = State::kBlocked;
    }
  }

  const FreeSpace& space_;
  const CellOptions& options_;
  double side_m_;
  Vec3 low_W_;
  std::vector<OctreeCell> cells_;
};

class CellSearch {
 public:
  CellSearch(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
             const CellOptions& options, const base::Deadline& deadline)
      : options_(options),
        deadline_(deadline),
        from_W_(from_W),
        to_W_(to_W),
        apart_m_(std::max((to_W - from_W).norm(), options.comfort_m)),
        tree_(space, options, whole(space, from_W, to_W, options)) {}

  CellResult run() {
    CellResult result;
    result.exhausted = search();
    if (has_met_) {
      result.way_W = way();
      if (!is_narrow_) find_narrow_ends();
      result.pocket = pocket_so_far();
    } else if (result.exhausted) {
      result.pocket = pocket();
    } else if (!is_late_) {
      result.pocket = pocket_so_far();
    }
    result.cells = tree_.size();
    return result;
  }

 private:
  struct Waiting {
    double worth;
    std::uint32_t cell;
    // The priority queue has the largest on top; among equals the one that was met first.
    bool operator<(const Waiting& other) const {
      return worth != other.worth ? worth < other.worth : cell > other.cell;
    }
  };

  static geometry::Box whole(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                             const CellOptions& options) {
    geometry::Box box = space.obstacles().index.bounds();
    box.extend(from_W).extend(to_W);
    const double margin_m =
        kMarginAround * (options.comfort_m + options.ball_radius_m + space.detect().clearance_m);
    // The ball cannot be beyond the bounds.
    const geometry::Bounds& bounds = space.obstacles().bounds;
    return {(box.min().array() - margin_m).max(bounds.min_W.array()),
            (box.max().array() + margin_m).min(bounds.max_W.array())};
  }

  /// Whether all that is reached from one end was looked at, and the other end is not among it.
  bool search() {
    const std::optional<std::uint32_t> from = tree_.free_cell_at(from_W_);
    const std::optional<std::uint32_t> to = tree_.free_cell_at(to_W_);
    if (!from || !to) return false;
    start_ = *from;
    goal_ = *to;
    reach(start_, 0);
    reach(goal_, 1);
    for (std::size_t turn = 0; !has_met_; ++turn) {
      if (!is_narrow_ && tree_.size() >= kCellsBeforeNarrow) find_narrow_ends();
      if (tree_.size() >= most_cells() || is_late()) return false;
      const std::optional<std::uint32_t> cell = next(turn % kEnds.size());
      if (!cell) return !is_late_;
      divide(*cell);
    }
    return false;
  }

  void find_narrow_ends() {
    is_narrow_.emplace();
    for (std::size_t end = 0; end < kEnds.size(); ++end) {
      bool has_room = !(options_.narrow_m > 0.0);
      for (std::uint32_t i = 0; i < tree_.size() && !has_room; ++i) {
        const OctreeCell& cell = tree_[i];
        if (cell.children != kNone || (cell.reached & kEnds[end]) == 0) continue;
        has_room = tree_.gap_m(cell, options_.narrow_m) >= options_.narrow_m;
      }
      (*is_narrow_)[end] = !has_room;
    }
  }

  [[nodiscard]] bool is_narrow(std::size_t end) const { return is_narrow_ && (*is_narrow_)[end]; }

  [[nodiscard]] std::size_t most_cells() const {
    const bool any_is_narrow = is_narrow(0) || is_narrow(1);
    return any_is_narrow ? std::min(options_.max_cells, options_.max_cells_if_narrow)
                         : options_.max_cells;
  }

  bool is_late() {
    if (looks_++ % kLooksPerClock == 0) is_late_ = deadline_.passed();
    return is_late_;
  }

  /// Which to divide for that end; nothing where none is left.
  std::optional<std::uint32_t> next(std::size_t end) {
    std::priority_queue<Waiting>& waiting = waiting_[end];
    while (!waiting.empty()) {
      const std::uint32_t cell = waiting.top().cell;
      waiting.pop();
      // It may have been divided for the other end.
      if (tree_[cell].children != kNone) continue;
      tree_[cell].waiting &= static_cast<std::uint8_t>(~kEnds[end]);
      if (!leads_nowhere(cell, end)) return cell;
      if (is_late()) break;
    }
    return std::nullopt;
  }

  /// Returns whether a cell need not be divided for that end. It need not if it stands in a closed
  /// corner, and each neighbour that was reached is in front of the walls together with one that is
  /// at least as large as the cell. The space in front of the walls is convex, so cells of that
  /// size lead past this cell, further from the walls, to every place that it leads to. Smaller
  /// neighbours alone prove nothing: other cells on their way may not be divided either.
  [[nodiscard]] bool leads_nowhere(std::uint32_t index, std::size_t end) const {
    std::vector<std::uint32_t> reached;
    tree_.for_each_neighbour(index, [&](std::uint32_t next) {
      if ((tree_[next].reached & kEnds[end]) != 0) reached.push_back(next);
    });
    while (!reached.empty()) {
      const auto as_large = std::ranges::find_if(
          reached, [&](std::uint32_t beside) { return tree_[beside].level <= tree_[index].level; });
      if (as_large == reached.end()) return false;
      const std::optional<ClosedCorner> corner = tree_.corner_at(tree_[index], tree_[*as_large]);
      if (!corner) return false;
      reached.erase(as_large);
      std::erase_if(reached, [&](std::uint32_t beside) {
        return corner->is_before_all(tree_.center_W(tree_[beside]));
      });
    }
    return true;
  }

  // And all that can be reached from there through free cells.
  void reach(std::uint32_t first, std::size_t end) {
    std::vector<std::uint32_t> open;
    const auto add = [&](std::uint32_t cell) {
      if ((tree_[cell].reached & kEnds[end]) != 0) return;
      if (tree_[cell].reached != 0) {
        // The rest of the region of the other end is known.
        has_met_ = true;
        return;
      }
      tree_[cell].reached |= kEnds[end];
      open.push_back(cell);
    };
    add(first);
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      tree_.for_each_neighbour(cell, [&](std::uint32_t next) {
        if (tree_[next].state == State::kMixed) put_off(next, end);
        if (tree_[next].state == State::kFree) add(next);
      });
    }
  }

  void put_off(std::uint32_t index, std::size_t end) {
    OctreeCell& cell = tree_[index];
    if ((cell.waiting & kEnds[end]) != 0 || !tree_.may_divide(cell)) return;
    cell.waiting |= kEnds[end];
    const Vec3 center_W = tree_.center_W(cell);
    // A way that leads there is so much longer than the straight one.
    const double share = apart_m_ / ((center_W - from_W_).norm() + (to_W_ - center_W).norm());
    waiting_[end].push({tree_.side_m(cell.level) * share * share, index});
  }

  void divide(std::uint32_t index) {
    const std::uint32_t first = tree_.divide(index);
    for (std::uint32_t child = first; child < first + 8; ++child) {
      if (tree_[child].state == State::kBlocked) continue;
      tree_.for_each_neighbour(child, [&](std::uint32_t next) {
        for (std::size_t end = 0; end < kEnds.size(); ++end) {
          if ((tree_[next].reached & kEnds[end]) == 0) continue;
          if (tree_[child].state == State::kFree) {
            reach(child, end);
          } else {
            put_off(child, end);
          }
        }
      });
    }
  }

  /// The region that was reached from an end.
  struct Region {
    geometry::Box box_W;
    double unsure_m = 0.0;
    double volume_m3 = 0.0;
  };

  [[nodiscard]] std::array<Region, 2> regions() const {
    std::array<Region, 2> regions;
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      const OctreeCell& cell = tree_[i];
      if (cell.children != kNone || cell.reached == 0) continue;
      const double half_m = 0.5 * tree_.side_m(cell.level);
      const Vec3 center_W = tree_.center_W(cell);
      geometry::Box box(center_W.array() - half_m, center_W.array() + half_m);
      double wall_m = 0.0;
      // The walls are somewhere in the cells beside it that are not free.
      tree_.for_each_neighbour(i, [&](std::uint32_t next) {
        if (tree_[next].state != State::kMixed) return;
        box.extend(tree_.center_W(tree_[next]));
        wall_m = std::max(wall_m, 0.5 * tree_.side_m(tree_[next].level));
      });
      for (std::size_t end = 0; end < kEnds.size(); ++end) {
        if ((cell.reached & kEnds[end]) == 0) continue;
        regions[end].box_W.extend(box);
        regions[end].unsure_m = std::max(regions[end].unsure_m, wall_m);
        regions[end].volume_m3 += std::pow(2.0 * half_m, 3);
      }
    }
    return regions;
  }

  /// The end from which less can be reached. Where all was looked at from the other one, there is
  /// no way out of this one either.
  [[nodiscard]] Pocket pocket() const {
    const std::array<Region, 2> found = regions();
    const bool is_at_end = found[1].box_W.diagonal().norm() < found[0].box_W.diagonal().norm();
    const std::size_t end = is_at_end ? 1 : 0;
    return {is_at_end, found[end].box_W, found[end].unsure_m, true, is_narrow(end)};
  }

  /// The end in a narrow place, or else, if there is no way, the one from which much less was
  /// reached so far. The two were given about as many cells.
  [[nodiscard]] std::optional<Pocket> pocket_so_far() const {
    if (start_ == kNone) return std::nullopt;
    const std::array<Region, 2> found = regions();
    const bool is_at_end =
        is_narrow(0) != is_narrow(1) ? is_narrow(1) : found[1].volume_m3 < found[0].volume_m3;
    const std::size_t end = is_at_end ? 1 : 0;
    const bool is_less = found[end].volume_m3 < kMuchLess * found[1 - end].volume_m3;
    const bool is_known = found[end].volume_m3 > 0.0 && (is_narrow(end) || (is_less && !has_met_));
    if (!is_known) return std::nullopt;
    return Pocket{is_at_end, found[end].box_W, found[end].unsure_m, false, is_narrow(end)};
  }

  [[nodiscard]] double step_cost_m(std::uint32_t a, std::uint32_t b) const {
    const double gap_m = static_cast<double>(std::min(tree_[a].gap_m, tree_[b].gap_m));
    const double near = std::clamp(1.0 - gap_m / options_.comfort_m, 0.0, 1.0);
    const double length_m = (tree_.center_W(tree_[a]) - tree_.center_W(tree_[b])).norm();
    return length_m * (1.0 + kMostNear * near);
  }

  /// Dijkstra's algorithm on the free cells that were reached. The straight way between the middles
  /// of two that have a face, or part of one, in common stays within the two: where it steps
  /// through it is nearer to the middle of the smaller one than that is wide, by similar triangles.
  [[nodiscard]] std::vector<Vec3> way() const {
    struct Step {
      double cost_m = std::numeric_limits<double>::infinity();
      std::uint32_t parent = kNone;
    };
    std::vector<Step> steps(tree_.size());
    std::priority_queue<Waiting> open;
    steps[start_].cost_m = 0.0;
    open.push({0.0, start_});
    while (!open.empty()) {
      const Waiting at = open.top();
      open.pop();
      if (at.cell == goal_) break;
      if (-at.worth > steps[at.cell].cost_m) continue;
      tree_.for_each_neighbour(at.cell, [&](std::uint32_t next) {
        if (tree_[next].reached == 0) return;
        const double cost_m = steps[at.cell].cost_m + step_cost_m(at.cell, next);
        if (!(cost_m < steps[next].cost_m)) return;
        steps[next] = {cost_m, at.cell};
        open.push({-cost_m, next});
      });
    }
    std::vector<Vec3> way_W = {to_W_, tree_.center_W(tree_[goal_])};
    for (std::uint32_t cell = goal_; cell != start_; cell = steps[cell].parent) {
      way_W.push_back(tree_.center_W(tree_[steps[cell].parent]));
    }
    way_W.push_back(from_W_);
    std::ranges::reverse(way_W);
    return way_W;
  }

  const CellOptions& options_;
  const base::Deadline& deadline_;
  const Vec3 from_W_;
  const Vec3 to_W_;
  const double apart_m_;
  CellTree tree_;
  std::uint32_t start_ = kNone;
  std::uint32_t goal_ = kNone;
  /// Mixed cells next to what was reached, by end.
  std::array<std::priority_queue<Waiting>, kEnds.size()> waiting_;
  /// By end; nothing while it is not known.
  std::optional<std::array<bool, kEnds.size()>> is_narrow_;
  bool has_met_ = false;
  std::size_t looks_ = 0;
  bool is_late_ = false;  ///< whether the deadline had passed when the clock was read last
};

}  // namespace

CellResult cell_way(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                    const CellOptions& options, const base::Deadline& deadline) {
  return CellSearch(space, from_W, to_W, options, deadline).run();
}

}  // namespace camway::correction
