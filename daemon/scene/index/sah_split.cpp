// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "daemon/scene/index/index_node.h"
#include "daemon/scene/index/node_splitter.h"

namespace camway::scene {

using geometry::Box;
using geometry::Vec3;

namespace {

constexpr std::size_t kBins = 16;

/// A place to split at: the plane between bins `bin` and `bin + 1` of an axis.
struct Split {
  int axis = 0;
  std::size_t bin = 0;
  std::size_t below = 0;                                     ///< entries of the lower side
  double cost_m2 = std::numeric_limits<double>::infinity();  ///< area times entries, both sides
};

/// Sixteen equal intervals of one side of a box.
class Bins {
 public:
  Bins(const Box& box, int axis) : low_(box.min()[axis]), size_(box.sizes()[axis]) {}

  [[nodiscard]] bool usable() const { return size_ > 0.0; }
  [[nodiscard]] std::size_t bin_of(double x) const {
    const double bin = (x - low_) / size_ * static_cast<double>(kBins);
    return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(kBins - 1)));
  }
  /// The plane at the end of `bin`.
  [[nodiscard]] double end_of(std::size_t bin) const {
    return low_ + size_ * (static_cast<double>(bin + 1) / static_cast<double>(kBins));
  }

 private:
  double low_;
  double size_;
};

/// Splits parts in two until a node is full, always the part of highest cost. Binned surface area
/// heuristic (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies", section
/// 3.3). Deviation: a node has up to eight children at once.
class SurfaceAreaDealer : public IndexDealer {
 public:
  explicit SurfaceAreaDealer(const IndexOptions& options) : options_(options) {}

  [[nodiscard]] std::vector<IndexPart> deal(IndexPart& part) const override {
    if (!may_split(part) || part.depth >= options_.max_depth) return {};
    std::vector<IndexPart> parts;
    parts.reserve(kNodeWidth);
    parts.push_back(std::move(part));
    while (parts.size() < kNodeWidth) {
      const auto costliest = std::max_element(
          parts.begin(), parts.end(),
          [&](const IndexPart& a, const IndexPart& b) { return urgency(a) < urgency(b); });
      if (!may_split(*costliest)) break;
      std::optional<IndexPart> upper = split(*costliest);
      costliest->is_final = !upper;
      if (upper) parts.insert(costliest + 1, std::move(*upper));
    }
    if (parts.size() == 1) {
      part = std::move(parts.front());
      return {};
    }
    for (IndexPart& child : parts) ++child.depth;
    return parts;
  }

 protected:
  /// Moves the upper side out of `part` and returns it. Returns nothing if no split pays.
  [[nodiscard]] virtual std::optional<IndexPart> split(IndexPart& part) const = 0;

  /// Cost of one more split for a query, in tests of entries.
  static constexpr double kSplitCost = 1.0;

  /// The best split along the longest side of `box` or, if none pays there, along any side.
  template <class TryAxis>
  static Split best_split(const IndexPart& part, const Box& box, const TryAxis& try_axis) {
    Eigen::Index longest = 0;
    box.sizes().maxCoeff(&longest);
    Split best;
    for (int i = 0; i < 3; ++i) {
      const int axis = (static_cast<int>(longest) + i) % 3;
      const Bins bins(box, axis);
      if (bins.usable()) try_axis(part, bins, axis, best);
      if (i == 0 && pays(best, part)) break;
    }
    return best;
  }

  static bool pays(const Split& split, const IndexPart& part) {
    return split.cost_m2 <
           (static_cast<double>(part.entries.size()) - kSplitCost) * half_area_m2(part.box);
  }

 private:
  [[nodiscard]] bool may_split(const IndexPart& part) const {
    return !part.is_final && part.entries.size() > options_.threshold;
  }
  [[nodiscard]] double urgency(const IndexPart& part) const {
    if (!may_split(part)) return -1.0;
    return half_area_m2(part.box) * static_cast<double>(part.entries.size());
  }

  IndexOptions options_;
};

/// BVH splitter: a triangle belongs to the side that contains the centre of its box.
class BvhDealer : public SurfaceAreaDealer {
 public:
  using SurfaceAreaDealer::SurfaceAreaDealer;

 private:
  struct Bin {
    EntryBounds bounds;
    std::size_t count = 0;

    [[nodiscard]] double cost_m2() const {
      return half_area_m2(bounds.box()) * static_cast<double>(count);
    }
  };

  static double twice_middle(const IndexEntry& entry, std::size_t axis) {
    return entry.low_m[axis] + entry.high_m[axis];
  }

  static Box middles(const IndexPart& part) {
    EntryBounds bounds;
    for (const IndexEntry& entry : part.entries) {
      std::array<double, 4> middle;
      for (std::size_t k = 0; k < 4; ++k) middle[k] = entry.low_m[k] + entry.high_m[k];
      bounds.extend(middle, middle);
    }
    return bounds.box();
  }

  static void try_axis(const IndexPart& part, const Bins& bins, int axis, Split& best) {
    std::array<Bin, kBins> content;
    for (const IndexEntry& entry : part.entries) {
      Bin& bin = content[bins.bin_of(twice_middle(entry, static_cast<std::size_t>(axis)))];
      bin.bounds.extend(entry);
      ++bin.count;
    }
    std::array<double, kBins> above_m2{};
    Bin above;
    for (std::size_t i = kBins; i-- > 1;) {
      above.bounds.extend(content[i].bounds);
      above.count += content[i].count;
      above_m2[i] = above.cost_m2();
    }
    Bin below;
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      below.bounds.extend(content[i].bounds);
      below.count += content[i].count;
      const double cost_m2 = below.cost_m2() + above_m2[i + 1];
      if (below.count > 0 && below.count < part.entries.size() && cost_m2 < best.cost_m2) {
        best = {axis, i, below.count, cost_m2};
      }
    }
  }

  [[nodiscard]] std::optional<IndexPart> split(IndexPart& part) const override {
    const Box middle_box = middles(part);
    const Split best = best_split(part, middle_box, try_axis);
    if (!pays(best, part)) return std::nullopt;
    const Bins bins(middle_box, best.axis);
    IndexPart upper;
    upper.depth = part.depth;
    upper.entries.reserve(part.entries.size() - best.below);
    // In place: the remaining entries move down.
    std::size_t kept = 0;
    for (const IndexEntry& entry : part.entries) {
      if (bins.bin_of(twice_middle(entry, static_cast<std::size_t>(best.axis))) <= best.bin) {
        part.entries[kept++] = entry;
      } else {
        upper.entries.push_back(entry);
      }
    }
    part.entries.resize(kept);
    part.box = bounds_of(part.entries);
    upper.box = bounds_of(upper.entries);
    return upper;
  }
};

/// k-d tree splitter: a triangle belongs to every side that it lies on.
class KdTreeDealer : public SurfaceAreaDealer {
 public:
  KdTreeDealer(const Mesh& mesh, const Box& bounds, const IndexOptions& options)
      : SurfaceAreaDealer(options), cutter_(mesh, bounds) {}

 private:
  /// Counts the entries that begin, and those that end, in each bin: their sums are the numbers of
  /// entries on both sides of a plane.
  static void try_axis(const IndexPart& part, const Bins& bins, int axis, Split& best) {
    std::array<std::size_t, kBins> begins{};
    std::array<std::size_t, kBins> ends{};
    const auto k = static_cast<std::size_t>(axis);
    for (const IndexEntry& entry : part.entries) {
      ++begins[bins.bin_of(entry.low_m[k])];
      ++ends[bins.bin_of(entry.high_m[k])];
    }
    std::size_t below = 0;
    std::size_t above = part.entries.size();
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      below += begins[i];
      above -= ends[i];
      Box low = part.box;
      Box high = part.box;
      low.max()[axis] = high.min()[axis] = bins.end_of(i);
      const double cost_m2 = half_area_m2(low) * static_cast<double>(below) +
                             half_area_m2(high) * static_cast<double>(above);
      if (static_cast<double>(below + above) <= part.budget && cost_m2 < best.cost_m2) {
        best = {axis, i, below, cost_m2};
      }
    }
  }

  [[nodiscard]] std::optional<IndexPart> split(IndexPart& part) const override {
    const Split best = best_split(part, part.box, try_axis);
    if (!pays(best, part)) return std::nullopt;
    std::array<IndexPart, 2> sides;
    sides[0].entries.reserve(best.below);
    sides[1].entries.reserve(part.entries.size() - best.below + best.below / 4);
    deal_to_sides(part, best.axis, Bins(part.box, best.axis).end_of(best.bin), sides);
    const auto lower = static_cast<double>(sides[0].entries.size());
    const auto upper = static_cast<double>(sides[1].entries.size());
    if (lower == 0.0 || upper == 0.0 || lower + upper > part.budget) return std::nullopt;
    for (IndexPart& side : sides) {
      side.depth = part.depth;
      side.budget = part.budget * static_cast<double>(side.entries.size()) / (lower + upper);
      side.box = bounds_of(side.entries);
    }
    part = std::move(sides[0]);
    return std::move(sides[1]);
  }

  void deal_to_sides(const IndexPart& part, int axis, double at,
                     std::array<IndexPart, 2>& sides) const {
    const auto k = static_cast<std::size_t>(axis);
    for (const IndexEntry& entry : part.entries) {
      if (entry.high_m[k] <= at) {
        sides[0].entries.push_back(entry);
      } else if (entry.low_m[k] >= at) {
        sides[1].entries.push_back(entry);
      } else {
        std::array<IndexEntry, 2> halves;
        cutter_.cut(entry, axis, at, halves[0], halves[1]);
        if (!halves[0].is_empty()) sides[0].entries.push_back(halves[0]);
        if (!halves[1].is_empty()) sides[1].entries.push_back(halves[1]);
      }
    }
  }

  TriangleCutter cutter_;
};

}  // namespace

std::unique_ptr<IndexDealer> make_kd_tree_dealer(const Mesh& mesh, const Box& bounds,
                                                 const IndexOptions& options) {
  return std::make_unique<KdTreeDealer>(mesh, bounds, options);
}

std::unique_ptr<IndexDealer> make_bvh_dealer(const IndexOptions& options) {
  return std::make_unique<BvhDealer>(options);
}

}  // namespace camway::scene
