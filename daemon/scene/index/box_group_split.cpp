// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "daemon/scene/index/index_node.h"
#include "daemon/scene/index/node_splitter.h"

namespace camway::scene {

using geometry::Box;

namespace {

constexpr std::size_t kBins = 16;

/// Cost of one more split for a query, in tests of entries.
constexpr double kSplitCost = 1.0;

/// A place to split at: between bins `bin` and `bin + 1` of an axis.
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

 private:
  double low_;
  double size_;
};

/// The entries of a bin, or of several.
struct BinContent {
  EntryBounds bounds;
  std::size_t count = 0;

  [[nodiscard]] double cost_m2() const {
    return half_area_m2(bounds.box()) * static_cast<double>(count);
  }
};

double twice_middle(const IndexEntry& entry, std::size_t axis) {
  return entry.low_m[axis] + entry.high_m[axis];
}

/// The bounds of the entries' middles, doubled.
Box middles(const IndexPart& part) {
  EntryBounds bounds;
  for (const IndexEntry& entry : part.entries) {
    std::array<double, 4> middle;
    for (std::size_t k = 0; k < 4; ++k) middle[k] = entry.low_m[k] + entry.high_m[k];
    bounds.extend(middle, middle);
  }
  return bounds.box();
}

/// Replaces `best` by a better split along `axis`, if there is one.
void try_axis(const IndexPart& part, const Bins& bins, int axis, Split& best) {
  std::array<BinContent, kBins> content;
  for (const IndexEntry& entry : part.entries) {
    BinContent& bin = content[bins.bin_of(twice_middle(entry, static_cast<std::size_t>(axis)))];
    bin.bounds.extend(entry);
    ++bin.count;
  }
  std::array<double, kBins> above_m2{};
  BinContent above;
  for (std::size_t i = kBins; i-- > 1;) {
    above.bounds.extend(content[i].bounds);
    above.count += content[i].count;
    above_m2[i] = above.cost_m2();
  }
  BinContent below;
  for (std::size_t i = 0; i + 1 < kBins; ++i) {
    below.bounds.extend(content[i].bounds);
    below.count += content[i].count;
    const double cost_m2 = below.cost_m2() + above_m2[i + 1];
    if (below.count > 0 && below.count < part.entries.size() && cost_m2 < best.cost_m2) {
      best = {axis, i, below.count, cost_m2};
    }
  }
}

bool pays(const Split& split, const IndexPart& part) {
  return split.cost_m2 <
         (static_cast<double>(part.entries.size()) - kSplitCost) * half_area_m2(part.box);
}

/// The best split along the longest side of `box` or, if none pays there, along any side.
Split best_split(const IndexPart& part, const Box& box) {
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

/// Moves the upper side out of `part` and returns it. Returns nothing if no split pays.
std::optional<IndexPart> split_in_two(IndexPart& part) {
  const Box middle_box = middles(part);
  const Split best = best_split(part, middle_box);
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

/// Splits parts in two until a node is full, always the part of highest cost; an entry belongs to
/// the side that contains the middle of its box. Binned surface area heuristic (Wald 2007, "On fast
/// construction of SAH-based bounding volume hierarchies", section 3.3). Deviation: a node has up
/// to eight children at once.
class BoxGroupSplitter : public NodeSplitter {
 public:
  explicit BoxGroupSplitter(const IndexOptions& options) : options_(options) {}

  [[nodiscard]] std::vector<IndexPart> split(IndexPart& part) const override {
    if (!may_split(part) || part.depth >= options_.max_depth) return {};
    std::vector<IndexPart> parts;
    parts.reserve(kNodeWidth);
    parts.push_back(std::move(part));
    while (parts.size() < kNodeWidth) {
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

  IndexOptions options_;
};

}  // namespace

std::unique_ptr<NodeSplitter> make_box_group_splitter(const IndexOptions& options) {
  return std::make_unique<BoxGroupSplitter>(options);
}

}  // namespace camway::scene
