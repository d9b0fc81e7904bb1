// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/index/node_splitter.h"

/// The parts that node splitters by surface area cost share: they split in two, at a plane between
/// bins, and again. Source: Wald 2007, "On fast construction of SAH-based bounding volume
/// hierarchies", section 3.3. Deviation: a node has up to eight children at once.
namespace camway::scene {

inline constexpr std::size_t kSplitBins = 16;

/// A place to split at: between bins `bin` and `bin + 1` of an axis.
struct BinSplit {
  int axis = 0;
  std::size_t bin = 0;
  std::size_t below = 0;                                     ///< entries of the lower side
  double cost_m2 = std::numeric_limits<double>::infinity();  ///< area times entries, both sides
};

/// `kSplitBins` equal intervals of one side of a box.
class SplitBins {
 public:
  SplitBins(const geometry::Box& box, int axis) : low_(box.min()[axis]), size_(box.sizes()[axis]) {}

  /// Returns false if the side has no length.
  [[nodiscard]] bool usable() const { return size_ > 0.0; }
  [[nodiscard]] std::size_t bin_of(double x) const {
    constexpr auto kBins = static_cast<double>(kSplitBins);
    return static_cast<std::size_t>(std::clamp((x - low_) / size_ * kBins, 0.0, kBins - 1.0));
  }
  /// Returns the coordinate of the plane at the end of `bin`.
  [[nodiscard]] double end_of(std::size_t bin) const {
    return low_ + size_ * (static_cast<double>(bin + 1) / static_cast<double>(kSplitBins));
  }

 private:
  double low_;
  double size_;
};

/// Returns whether queries of the part cost less with this split than without one.
bool pays(const BinSplit& split, const IndexPart& part);

/// Returns the best split along the longest side of `box` or, if none pays there, along any side.
/// `try_axis(bins, axis, best)` replaces `best` by a better split along one axis, if there is one.
template <class TryAxis>
BinSplit best_split(const IndexPart& part, const geometry::Box& box, const TryAxis& try_axis) {
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  BinSplit best;
  for (int i = 0; i < 3; ++i) {
    const int axis = (static_cast<int>(longest) + i) % 3;
    const SplitBins bins(box, axis);
    if (bins.usable()) try_axis(bins, axis, best);
    if (i == 0 && pays(best, part)) break;
  }
  return best;
}

/// Splits parts in two until a node is full, always the part of highest cost.
class BinarySplitter : public NodeSplitter {
 public:
  explicit BinarySplitter(const IndexOptions& options) : options_(options) {}

  [[nodiscard]] std::vector<IndexPart> split(IndexPart& part) const final;

 private:
  /// Moves the upper side out of `part` and returns it. Returns nothing if no split pays.
  [[nodiscard]] virtual std::optional<IndexPart> split_in_two(IndexPart& part) const = 0;

  [[nodiscard]] bool may_split(const IndexPart& part) const;
  [[nodiscard]] double urgency(const IndexPart& part) const;

  IndexOptions options_;
};

}  // namespace camway::scene
