// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_search.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <queue>
#include <vector>

#include "daemon/correction/search/cell_regions.h"
#include "daemon/correction/search/cell_route.h"
#include "daemon/correction/search/cell_tree.h"
#include "daemon/correction/search/closed_corner.h"

namespace camway::correction {

namespace {

using geometry::Vec3;

// Chosen by measurement; neither changes what is free.
constexpr double kMarginAround = 4.0;  // balls around the scene: ways may lead there too

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
    search();
    result.exhausted = exhausted_end_.has_value();
    if (has_met_) {
      result.way_W = way();
      if (!is_narrow_) find_narrow_ends();
    }
    if (exhausted_end_) {
      result.pocket = complete_pocket(tree_, *exhausted_end_, is_narrow());
    } else if (has_met_ || !is_late_) {
      result.pocket = pocket_so_far(tree_, is_narrow(), has_met_);
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

  /// The cube that is divided is about this box.
  static geometry::Box whole(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                             const CellOptions& options) {
    geometry::Box box = space.obstacles().index.bounds();
    box.extend(from_W).extend(to_W);
    const double radius_m = std::max(options.ball_radius_m, options.body_radius_m);
    const double margin_m = kMarginAround *
                            (options.comfort_m + radius_m + space.query().required_clearance_m());
    // The ball cannot be beyond the bounds.
    const geometry::Bounds& bounds = space.obstacles().bounds;
    return {(box.min().array() - margin_m).max(bounds.min_W.array()),
            (box.max().array() + margin_m).min(bounds.max_W.array())};
  }

  /// Divides cells until the ends meet, all that can be reached from one of them was looked at, or
  /// a limit is reached.
  void search() {
    const std::optional<std::uint32_t> from = tree_.free_cell_at(from_W_);
    const std::optional<std::uint32_t> to = tree_.free_cell_at(to_W_);
    if (!from || !to) return;
    start_ = *from;
    goal_ = *to;
    reach(start_, 0);
    reach(goal_, 1);
    for (std::size_t turn = 0; !has_met_; ++turn) {
      if (!is_narrow_ && tree_.size() >= kCellsBeforeNarrow) find_narrow_ends();
      if (tree_.size() >= most_cells() || is_late()) return;
      const std::size_t end = turn % kCellEnds;
      const std::optional<std::uint32_t> cell = next(end);
      if (!cell) {
        if (!is_late_) exhausted_end_ = end;
        return;
      }
      divide(*cell);
    }
  }

  void find_narrow_ends() { is_narrow_ = ends_in_narrow_places(tree_, options_.narrow_m); }

  // Neither end is taken to be in a narrow place while that is not known.
  [[nodiscard]] OfEnds<bool> is_narrow() const { return is_narrow_.value_or(OfEnds<bool>{}); }

  [[nodiscard]] std::size_t most_cells() const {
    const bool any_is_narrow = is_narrow()[0] || is_narrow()[1];
    return any_is_narrow ? std::min(options_.max_cells, options_.max_cells_if_narrow)
                         : options_.max_cells;
  }

  static constexpr std::size_t kStepsPerDeadlineCheck = 64;  // a step is a look at a cell

  bool is_late() {
    if (looks_++ % kStepsPerDeadlineCheck == 0) is_late_ = deadline_.passed();
    return is_late_;
  }

  /// Takes the next cell to divide for that end; nothing where none is left.
  std::optional<std::uint32_t> next(std::size_t end) {
    std::priority_queue<Waiting>& waiting = waiting_[end];
    while (!waiting.empty()) {
      const std::uint32_t cell = waiting.top().cell;
      waiting.pop();
      // It may have been divided for the other end.
      if (tree_[cell].is_divided()) continue;
      tree_[cell].waiting.remove(end);
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
      if (tree_[next].reached.has(end)) reached.push_back(next);
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

  // Marks a cell, and all that can be reached from it through free cells.
  void reach(std::uint32_t first, std::size_t end) {
    std::vector<std::uint32_t> open;
    const auto add = [&](std::uint32_t cell) {
      if (tree_[cell].reached.has(end)) return;
      if (!tree_[cell].reached.empty()) {
        // The rest of the region of the other end is known.
        has_met_ = true;
        return;
      }
      tree_[cell].reached.add(end);
      open.push_back(cell);
    };
    add(first);
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      tree_.for_each_neighbour(cell, [&](std::uint32_t next) {
        if (tree_[next].state == CellState::kMixed) put_off(next, end);
        if (tree_[next].state == CellState::kFree) add(next);
      });
    }
  }

  void put_off(std::uint32_t index, std::size_t end) {
    OctreeCell& cell = tree_[index];
    if (cell.waiting.has(end) || !tree_.may_divide(cell)) return;
    cell.waiting.add(end);
    const Vec3 center_W = tree_.center_W(cell);
    // A way that leads there is so much longer than the straight one.
    const double share = apart_m_ / ((center_W - from_W_).norm() + (to_W_ - center_W).norm());
    waiting_[end].push({tree_.side_m(cell.level) * share * share, index});
  }

  void divide(std::uint32_t index) {
    const std::uint32_t first = tree_.divide(index);
    for (std::uint32_t child = first; child < first + 8; ++child) {
      if (tree_[child].state == CellState::kBlocked) continue;
      tree_.for_each_neighbour(child, [&](std::uint32_t next) {
        for (std::size_t end = 0; end < kCellEnds; ++end) {
          if (!tree_[next].reached.has(end)) continue;
          if (tree_[child].state == CellState::kFree) {
            reach(child, end);
          } else {
            put_off(child, end);
          }
        }
      });
    }
  }

  [[nodiscard]] std::vector<Vec3> way() const {
    std::vector<Vec3> way_W = cheapest_way(tree_, start_, goal_, options_.comfort_m);
    way_W.insert(way_W.begin(), from_W_);
    way_W.push_back(to_W_);
    return way_W;
  }

  const CellOptions& options_;
  const base::Deadline& deadline_;
  const Vec3 from_W_;
  const Vec3 to_W_;
  const double apart_m_;
  CellTree tree_;
  std::uint32_t start_ = kNoCell;
  std::uint32_t goal_ = kNoCell;
  /// Mixed cells next to what was reached, by end.
  OfEnds<std::priority_queue<Waiting>> waiting_;
  /// Whether each end is in a narrow place; nothing while that is not known.
  std::optional<OfEnds<bool>> is_narrow_;
  bool has_met_ = false;
  /// The end from which everything that can be reached was looked at; the other is not among it.
  std::optional<std::size_t> exhausted_end_;
  std::size_t looks_ = 0;
  bool is_late_ = false;  ///< whether the deadline had passed when the clock was read last
};

}  // namespace

CellResult cell_way(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                    const CellOptions& options, const base::Deadline& deadline) {
  return CellSearch(space, from_W, to_W, options, deadline).run();
}

}  // namespace camway::correction
