// SPDX-License-Identifier: MIT
#include <array>
#include <optional>

#include "daemon/scene/index/binary_splitter.h"

namespace camway::scene {

using geometry::Box;

namespace {

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
void try_axis(const IndexPart& part, const SplitBins& bins, int axis, BinSplit& best) {
  std::array<BinContent, kSplitBins> content;
  for (const IndexEntry& entry : part.entries) {
    BinContent& bin = content[bins.bin_of(twice_middle(entry, static_cast<std::size_t>(axis)))];
    bin.bounds.extend(entry);
    ++bin.count;
  }
  std::array<double, kSplitBins> above_m2{};
  BinContent above;
  for (std::size_t i = kSplitBins; i-- > 1;) {
    above.bounds.extend(content[i].bounds);
    above.count += content[i].count;
    above_m2[i] = above.cost_m2();
  }
  BinContent below;
  for (std::size_t i = 0; i + 1 < kSplitBins; ++i) {
    below.bounds.extend(content[i].bounds);
    below.count += content[i].count;
    const double cost_m2 = below.cost_m2() + above_m2[i + 1];
    if (below.count > 0 && below.count < part.entries.size() && cost_m2 < best.cost_m2) {
      best = {axis, i, below.count, cost_m2};
    }
  }
}

/// Splits boxes; an entry belongs to the side that contains the middle of its box.
class BoxGroupSplitter : public BinarySplitter {
 public:
  using BinarySplitter::BinarySplitter;

 private:
  [[nodiscard]] std::optional<IndexPart> split_in_two(IndexPart& part) const override {
    const Box middle_box = middles(part);
    const BinSplit best =
        best_split(part, middle_box, [&](const SplitBins& bins, int axis, BinSplit& best_yet) {
          try_axis(part, bins, axis, best_yet);
        });
    if (!pays(best, part)) return std::nullopt;
    const SplitBins bins(middle_box, best.axis);
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

}  // namespace

std::unique_ptr<NodeSplitter> make_box_group_splitter(const IndexOptions& options) {
  return std::make_unique<BoxGroupSplitter>(options);
}

}  // namespace camway::scene
