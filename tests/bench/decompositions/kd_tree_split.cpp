// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/kd_tree_split.h"

#include <array>
#include <optional>

#include "daemon/scene/index/binary_splitter.h"

namespace camway::bench {

using geometry::Box;
using scene::BinSplit;
using scene::half_area_m2;
using scene::IndexEntry;
using scene::IndexPart;
using scene::SplitBins;

namespace {

/// Counts the entries that begin, and those that end, in each bin: their sums are the numbers of
/// entries on both sides of a plane.
void try_axis(const IndexPart& part, const SplitBins& bins, int axis, BinSplit& best) {
  std::array<std::size_t, scene::kSplitBins> begins{};
  std::array<std::size_t, scene::kSplitBins> ends{};
  const auto k = static_cast<std::size_t>(axis);
  for (const IndexEntry& entry : part.entries) {
    ++begins[bins.bin_of(entry.low_m[k])];
    ++ends[bins.bin_of(entry.high_m[k])];
  }
  std::size_t below = 0;
  std::size_t above = part.entries.size();
  for (std::size_t i = 0; i + 1 < scene::kSplitBins; ++i) {
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

/// Splits space, and cuts triangles (Wald & Havran 2006, "On building fast kd-trees for ray
/// tracing, and on doing that in O(N log N)").
class KdTreeSplitter : public scene::BinarySplitter {
 public:
  KdTreeSplitter(const scene::Mesh& mesh, const Box& bounds, const scene::IndexOptions& options)
      : BinarySplitter(options), cutter_(mesh, bounds) {}

 private:
  [[nodiscard]] std::optional<IndexPart> split_in_two(IndexPart& part) const override {
    const BinSplit best =
        scene::best_split(part, part.box, [&](const SplitBins& bins, int axis, BinSplit& best_yet) {
          try_axis(part, bins, axis, best_yet);
        });
    if (!pays(best, part)) return std::nullopt;
    std::array<IndexPart, 2> sides;
    sides[0].entries.reserve(best.below);
    sides[1].entries.reserve(part.entries.size() - best.below + best.below / 4);
    deal_to_sides(part, best.axis, SplitBins(part.box, best.axis).end_of(best.bin), sides);
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

  scene::TriangleCutter cutter_;
};

}  // namespace

std::unique_ptr<scene::NodeSplitter> make_kd_tree_splitter(const scene::Mesh& mesh,
                                                           const Box& bounds,
                                                           const scene::IndexOptions& options) {
  return std::make_unique<KdTreeSplitter>(mesh, bounds, options);
}

}  // namespace camway::bench
