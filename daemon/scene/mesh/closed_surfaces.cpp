// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/closed_surfaces.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace camway::scene {
namespace {

struct Column {
  IndexSet seams;    ///< where the sum of `patches` is not closed
  IndexSet patches;  ///< what was added up
};

class Reduction {
 public:
  Reduction(const std::vector<IndexSet>& seams_of, std::size_t seams, std::uint64_t max_steps)
      : seams_of_(seams_of), owner_(seams, kNoIndex), max_steps_(max_steps) {}

  ReducedPatches run(std::span<const std::uint32_t> order) {
    for (const std::uint32_t patch : order) {
      Column column{.seams = seams_of_[patch], .patches = {patch}};
      if (!reduce(column)) {
        result_.complete = false;
        break;
      }
      keep(std::move(column));
    }
    return std::move(result_);
  }

 private:
  /// False if the steps are used up.
  bool reduce(Column& column) {
    while (!column.seams.empty() && owner_[column.seams.back()] != kNoIndex) {
      const Column& other = columns_[owner_[column.seams.back()]];
      steps_ +=
          column.seams.size() + column.patches.size() + other.seams.size() + other.patches.size();
      if (steps_ > max_steps_) return false;
      column.seams = sum_mod_2(column.seams, other.seams);
      column.patches = sum_mod_2(column.patches, other.patches);
    }
    return true;
  }

  void keep(Column&& column) {
    if (column.seams.empty()) {
      for (IndexSet& part : connected_parts(column.patches, seams_of_)) {
        result_.surfaces.push_back(std::move(part));
      }
      return;
    }
    owner_[column.seams.back()] = static_cast<std::uint32_t>(columns_.size());
    columns_.push_back(std::move(column));
  }

  const std::vector<IndexSet>& seams_of_;
  std::vector<std::uint32_t> owner_;  ///< by seam: the column that ends with it
  std::uint64_t max_steps_;
  std::uint64_t steps_ = 0;
  std::vector<Column> columns_;
  ReducedPatches result_;
};

}  // namespace

IndexSet sum_mod_2(const IndexSet& a, const IndexSet& b) {
  IndexSet result;
  result.reserve(a.size() + b.size());
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

std::vector<IndexSet> seams_of_patches(const PatchComplex& complex) {
  std::vector<IndexSet> result(complex.patches.size());
  for (std::uint32_t seam = 0; seam < complex.seams.size(); ++seam) {
    for (const std::uint32_t patch : complex.seams[seam]) result[patch].push_back(seam);
  }
  return result;
}

std::vector<IndexSet> connected_parts(const IndexSet& patches,
                                      const std::vector<IndexSet>& seams_of) {
  std::vector<std::uint32_t> parent(patches.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> uses;  // seam, position in `patches`
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    for (const std::uint32_t seam : seams_of[patches[i]]) uses.emplace_back(seam, i);
  }
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].first != uses[i - 1].first) continue;
    const std::uint32_t a = root(uses[i].second);
    const std::uint32_t b = root(uses[i - 1].second);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<IndexSet> parts;
  std::vector<std::uint32_t> part_of(patches.size(), kNoIndex);
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    const std::uint32_t r = root(i);
    if (part_of[r] == kNoIndex) {
      part_of[r] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part_of[r]].push_back(patches[i]);
  }
  return parts;
}

ReducedPatches reduce_patches(const PatchComplex& complex, const std::vector<IndexSet>& seams_of,
                              std::span<const std::uint32_t> order, std::uint64_t max_steps) {
  return Reduction(seams_of, complex.seams.size(), max_steps).run(order);
}

ClosedSurfaces find_closed_surfaces(const Mesh& mesh) {
  ClosedSurfaces result{.complex = make_patch_complex(mesh), .seams_of = {}, .surfaces = {}};
  result.seams_of = seams_of_patches(result.complex);
  std::vector<std::uint32_t> order(result.complex.patches.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return result.complex.patches[a].size() < result.complex.patches[b].size();
  });
  ReducedPatches reduced =
      reduce_patches(result.complex, result.seams_of, order, kMaxEliminationSteps);
  result.surfaces = std::move(reduced.surfaces);
  result.complete = reduced.complete;
  return result;
}

}  // namespace camway::scene
