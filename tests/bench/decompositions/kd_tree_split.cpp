// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/kd_tree_split.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace camway::bench {

using geometry::Box;
using scene::half_area_m2;
using scene::IndexEntry;
using scene::IndexPart;

namespace {

constexpr std::size_t kBins = 16;

/// Cost of one more split for a query, in tests of entries.
constexpr double kSplitCost = 1.0;

/// A plane to split at: the end of bin `bin` of an axis.
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

bool pays(const Split& split, const IndexPart& part) {
  return split.cost_m2 <
         (static_cast<double>(part.entries.size()) - kSplitCost) * half_area_m2(part.box);
}

/// Counts the entries that begin, and those that end, in each bin: their sums are the numbers of
/// entries on both sides of a plane.
void try_axis(const IndexPart& part, const Bins& bins, int axis, Split& best) {
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

/// The best split across the longest side of the part or, if none pays there, across any side.
Split best_split(const IndexPart& part) {
  Eigen::Index longest = 0;
  part.box.sizes().maxCoeff(&longest);
  Split best;
  for (int i = 0; i < 3; ++i) {
    const int axis = (static_cast<int>(longest) + i) % 3;
    const Bins bins(part.box, axis);
    if (bins.usable()) try_axis(part, bins, axis, best);
    if (i == 0 && pays(best, part)) break;
  }
  return best;
}

/// Splits parts in two until a node is full, always the part of highest cost. Binned surface area
/// heuristic (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies", section
/// 3.3; for k-d trees Wald & Havran 2006). Deviation: a node has up to eight children at once.
class KdTreeSplitter : public scene::NodeSplitter {
 public:
  KdTreeSplitter(const scene::Mesh& mesh, const Box& bounds, const scene::IndexOptions& options)
      : options_(options), cutter_(mesh, bounds) {}

  [[nodiscard]] std::vector<IndexPart> split(IndexPart& part) const override {
    if (!may_split(part) || part.depth >= options_.max_depth) return {};
    std::vector<IndexPart> parts;
    parts.reserve(scene::kNodeWidth);
    parts.push_back(std::move(part));
    while (parts.size() < scene::kNodeWidth) {
      const auto costliest = std::max_element(
          parts.begin(), parts.end(),
          [&](const IndexPart& a, const IndexPart& b) { return urgency(a) < urgency(b); });
      if (!may_split(*costliest)) break;
      std::optional<IndexPart> upper = split_in_two(*costliest);
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

 private:
  [[nodiscard]] bool may_split(const IndexPart& part) const {
    return !part.is_final && part.entries.size() > options_.threshold;
  }
  [[nodiscard]] double urgency(const IndexPart& part) const {
    if (!may_split(part)) return -1.0;
    return half_area_m2(part.box) * static_cast<double>(part.entries.size());
  }

  /// Moves the upper side out of `part` and returns it. Returns nothing if no split pays.
  [[nodiscard]] std::optional<IndexPart> split_in_two(IndexPart& part) const {
    const Split best = best_split(part);
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

  scene::IndexOptions options_;
  scene::TriangleCutter cutter_;
};

}  // namespace

std::unique_ptr<scene::NodeSplitter> make_kd_tree_splitter(const scene::Mesh& mesh,
                                                           const Box& bounds,
                                                           const scene::IndexOptions& options) {
  return std::make_unique<KdTreeSplitter>(mesh, bounds, options);
}

}  // namespace camway::bench
