// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/index/index_node.h"
#include "daemon/scene/index/node_splitter.h"

namespace camway::scene {

using geometry::Box;
using geometry::Vec3;

namespace {

using Octants = std::array<std::vector<IndexEntry>, 8>;

/// A cube slightly larger than `bounds`. A cube, so that cells do not become flatter than the
/// scene. Larger, so that a floor at the very bottom lies inside the lower octants, not on their
/// boundary, and so that the rounding of a cell's centre never leaves the cell.
Box root_cell(const Box& bounds) {
  const double largest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  const double extent = bounds.sizes().maxCoeff();
  // The centre of a cell has a rounding of u·largest at each of at most 20 levels.
  const double margin = std::max(
      {0x1p-30 * extent, 64.0 * geometry::kUnitRoundoff * largest, geometry::kSmallestNormal});
  const Vec3 low = bounds.min() - Vec3::Constant(margin);
  return {low, low + Vec3::Constant(extent + 3.0 * margin)};
}

Box octant_cell(const Box& cell, const Vec3& middle, std::size_t octant) {
  Box result = cell;
  for (int k = 0; k < 3; ++k) {
    if ((octant >> k) & 1U) {
      result.min()[k] = middle[k];
    } else {
      result.max()[k] = middle[k];
    }
  }
  return result;
}

/// Whether doubles can tell the centre of the cell from its sides.
bool splits_space(const Box& cell, const Vec3& middle) {
  return (middle.array() > cell.min().array() && middle.array() < cell.max().array()).all();
}

/// Replaces `cell` by the octant that contains `box`. Returns false if there is none.
bool shrink_to_octant(const Box& box, const Vec3& middle, Box& cell) {
  std::size_t octant = 0;
  for (int k = 0; k < 3; ++k) {
    if (box.max()[k] <= middle[k]) continue;
    if (box.min()[k] < middle[k]) return false;
    octant |= std::size_t{1} << k;
  }
  cell = octant_cell(cell, middle, octant);
  return true;
}

/// Octree splitter (Ptacek & Johnstone 2006, section 3): eight octants, and a triangle goes to
/// every octant that it lies in. Deviations: a triangle in the plane between octants goes to the
/// lower side only; a triangle is distributed by the box of its piece in the cell, so it sometimes
/// goes to an octant that it only comes close to.
class OctreeSplitter : public NodeSplitter {
 public:
  OctreeSplitter(const Mesh& mesh, const Box& bounds, const IndexOptions& options)
      : options_(options), root_(root_cell(bounds)), cutter_(mesh, bounds) {}

  [[nodiscard]] std::vector<IndexPart> split(IndexPart& part) const override {
    if (part.is_final || part.entries.size() <= options_.threshold ||
        part.depth >= options_.max_depth) {
      return {};
    }
    Box cell = part.depth == 0 ? root_ : part.cell;
    Vec3 middle;
    do {
      middle = 0.5 * cell.min() + 0.5 * cell.max();
      if (!splits_space(cell, middle)) return {};
    } while (shrink_to_octant(part.box, middle, cell));
    Octants octants;
    reserve(part, middle, octants);
    for (const IndexEntry& entry : part.entries) split_entry(entry, middle, 0, 0, octants);
    std::vector<IndexPart> parts = parts_of(octants, cell, middle, part);
    if (!worth_splitting(parts, part)) return {};
    part.entries = {};
    return parts;
  }

 private:
  /// Reserves about what each octant will get: the number of entries with their lowest corner in
  /// it.
  static void reserve(const IndexPart& part, const Vec3& middle, Octants& octants) {
    std::array<std::size_t, 8> counts{};
    for (const IndexEntry& entry : part.entries) {
      const unsigned octant = (entry.low_m[0] >= middle[0] ? 1U : 0U) +
                              (entry.low_m[1] >= middle[1] ? 2U : 0U) +
                              (entry.low_m[2] >= middle[2] ? 4U : 0U);
      ++counts[octant];
    }
    for (std::size_t i = 0; i < octants.size(); ++i) octants[i].reserve(counts[i] + counts[i] / 4);
  }

  /// Distributes `entry` by the planes of the axes from `axis` on; `octant` has the bits of the
  /// axes before.
  void split_entry(const IndexEntry& entry, const Vec3& middle, int axis, std::size_t octant,
                   Octants& octants) const {
    for (int k = axis; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (entry.high_m[at] <= middle[k]) continue;
      const std::size_t upper = octant | std::size_t{1} << k;
      if (entry.low_m[at] < middle[k]) {
        IndexEntry low;
        IndexEntry high;
        cutter_.cut(entry, k, middle[k], low, high);
        if (!low.is_empty()) split_entry(low, middle, k + 1, octant, octants);
        if (!high.is_empty()) split_entry(high, middle, k + 1, upper, octants);
        return;
      }
      octant = upper;
    }
    octants[octant].push_back(entry);
  }

  static std::vector<IndexPart> parts_of(Octants& octants, const Box& cell, const Vec3& middle,
                                         const IndexPart& part) {
    std::size_t entries = 0;
    for (const std::vector<IndexEntry>& octant : octants) entries += octant.size();
    std::vector<IndexPart> parts;
    parts.reserve(octants.size());
    for (std::size_t octant = 0; octant < octants.size(); ++octant) {
      if (octants[octant].empty()) continue;
      IndexPart child;
      child.cell = octant_cell(cell, middle, octant);
      child.box = bounds_of(octants[octant]);
      child.entries = std::move(octants[octant]);
      child.budget =
          part.budget * (static_cast<double>(child.entries.size()) / static_cast<double>(entries));
      child.depth = part.depth + 1;
      parts.push_back(std::move(child));
    }
    return parts;
  }

  /// False if the copies would exceed the budget, if the octants would hold nearly all entries
  /// again on average, or if a query in this cell would on average test as many entries as before
  /// (surface area heuristic, Goldsmith & Salmon 1987).
  static bool worth_splitting(const std::vector<IndexPart>& parts, const IndexPart& part) {
    if (parts.empty()) return false;
    double entries = 0.0;
    double asked = 0.0;
    for (const IndexPart& child : parts) {
      const auto count = static_cast<double>(child.entries.size());
      entries += count;
      asked += half_area_m2(child.box) * count;
    }
    const auto occupied = static_cast<double>(parts.size());
    if (entries > kNearlyAll * occupied * static_cast<double>(part.entries.size())) return false;
    const auto members = static_cast<double>(part.entries.size());
    const double copy_cost = members < kFew ? kCopyCostOfFew : kCopyCost;
    const double asked_after =
        asked / half_area_m2(part.box) + kNodeCost + copy_cost * (entries - members);
    return entries <= part.budget && asked_after < members;
  }

  static constexpr double kNearlyAll = 0.8;
  /// Cost of visiting a node, in tests of entries.
  static constexpr double kNodeCost = 4.0;
  /// Cost of a copy, in tests of entries. It is high for few entries, where no further split makes
  /// up for it: in the furnished house that halves the index, and no query takes longer.
  static constexpr double kCopyCost = 0.25;
  static constexpr double kCopyCostOfFew = 1.0;
  static constexpr double kFew = 256.0;

  IndexOptions options_;
  Box root_;
  TriangleCutter cutter_;
};

}  // namespace

std::unique_ptr<NodeSplitter> make_octree_splitter(const Mesh& mesh, const Box& bounds,
                                                   const IndexOptions& options) {
  return std::make_unique<OctreeSplitter>(mesh, bounds, options);
}

}  // namespace camway::scene
